// Writer and Reader: bytes from values and back.
//
// A type lists its fields once, in `template <class Archive> void serialize(Archive&, T&)`, and that one list
// serves both directions, so the two cannot disagree.  Bytes are little-endian and without padding whatever
// the machine; a struct is never copied as a whole.
//
// A Reader trusts nothing: every count is checked against the bytes that are left before memory is taken, a
// tag outside of its list or a missing byte makes the reader fail, and a failed reader yields zeros.  Ask
// ok() at the end; a message is good only if ok() and nothing is left.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace rayshade {

// Leaves new elements as they are: a Writer makes room and then fills it.
template <class T>
struct NoFill : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = NoFill<U>;
  };
  template <class U, class... A>
  void construct(U* at, A&&... from) {
    if constexpr (sizeof...(A) > 0) ::new (static_cast<void*>(at)) U(std::forward<A>(from)...);
  }
};

using Bytes = std::vector<std::byte, NoFill<std::byte>>;

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

static_assert(std::endian::native == std::endian::little,
              "archive.h copies numbers as they lie in memory; a big-endian machine needs a byte swap here");

// Appends to `out`, which has its final size when the Writer is gone; nobody else may touch it before.
class Writer {
 public:
  static constexpr bool kReading = false;

  explicit Writer(Bytes& out) : out_(out), used_(out.size()) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { out_.resize(used_); }

  template <class... T>
  void operator()(const T&... values) {
    if constexpr ((PlainNumber<T> && ...)) {
      // Numbers in a row are made room for once: most of what travels is points, directions and colours.
      std::byte* to = room((sizeof(T) + ... + 0));
      ((std::memcpy(to, &values, sizeof values), to += sizeof values), ...);
    } else {
      (put(values), ...);
    }
  }

 private:
  std::byte* room(std::size_t size) {
    const std::size_t at = used_;
    used_ += size;
    if (used_ > out_.size()) grow();
    return out_.data() + at;
  }
  // Some more than is wanted, so that it is seldom called.
  void grow() {
    constexpr std::size_t kAhead = 256;
    out_.resize(used_ + kAhead);
  }
  void raw(const void* from, std::size_t size) {
    std::byte* to = room(size);
    if (size > 0) std::memcpy(to, from, size);
  }
  template <PlainNumber T>
  void put(const T& value) {
    raw(&value, sizeof value);
  }
  void putCount(std::size_t count) { put(static_cast<std::uint32_t>(count)); }
  void put(const std::string& text) {
    putCount(text.size());
    raw(text.data(), text.size());
  }
  template <class T, class Allocator>
  void put(const std::vector<T, Allocator>& list) {
    putCount(list.size());
    if constexpr (PlainNumber<T> && !std::is_same_v<T, bool>) {
      if (!list.empty()) raw(list.data(), list.size() * sizeof(T));
    } else {
      for (const T& element : list) put(element);
    }
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& list) {
    for (const T& element : list) put(element);
  }
  template <class T>
  void put(const std::optional<T>& maybe) {
    put(static_cast<std::uint8_t>(maybe.has_value()));
    if (maybe) put(*maybe);
  }
  template <class... T>
  void put(const std::variant<T...>& choice) {
    put(static_cast<std::uint8_t>(choice.index()));
    std::visit([this](const auto& value) { this->put(value); }, choice);
  }
  template <class T>
  requires std::is_class_v<T>
  void put(const T& value) {
    serialize(*this, const_cast<T&>(value));  // a Writer reads its values only
  }

  Bytes& out_;
  std::size_t used_;
};

class Reader {
 public:
  static constexpr bool kReading = true;

  explicit Reader(std::span<const std::byte> in) : in_(in) {}

  bool ok() const { return ok_; }
  std::size_t left() const { return in_.size(); }
  void fail() {
    ok_ = false;
    in_ = {};
  }

  template <class... T>
  void operator()(T&... values) {
    if constexpr ((PlainNumber<T> && ...) && !(std::is_same_v<T, bool> || ...)) {
      if ((sizeof(T) + ... + 0) > in_.size()) {
        fail();
        ((values = T{}), ...);
        return;
      }
      const std::byte* from = in_.data();
      ((std::memcpy(&values, from, sizeof values), from += sizeof values), ...);
      in_ = in_.subspan((sizeof(T) + ... + 0));
    } else {
      (get(values), ...);
    }
  }

 private:
  void raw(void* to, std::size_t size) {
    if (size > in_.size()) {
      fail();
      std::memset(to, 0, size);
      return;
    }
    std::memcpy(to, in_.data(), size);
    in_ = in_.subspan(size);
  }
  template <PlainNumber T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      raw(&byte, 1);
      if (byte > 1) fail();
      value = byte == 1;
    } else {
      raw(&value, sizeof value);
    }
  }
  // A count of things of at least `least` bytes each; fails when they cannot all be there.
  std::size_t count(std::size_t least) {
    std::uint32_t n = 0;
    get(n);
    if (n > in_.size() / least) {
      fail();
      return 0;
    }
    return n;
  }
  void get(std::string& text) {
    text.resize(count(1));
    if (!text.empty()) raw(text.data(), text.size());
  }
  template <class T, class Allocator>
  void get(std::vector<T, Allocator>& list) {
    list.clear();
    if constexpr (PlainNumber<T> && !std::is_same_v<T, bool>) {
      list.resize(count(sizeof(T)));
      if (!list.empty()) raw(list.data(), list.size() * sizeof(T));
    } else {
      const std::size_t n = count(1);
      for (std::size_t i = 0; i < n && ok_; ++i) {
        get(list.emplace_back());
      }
    }
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& list) {
    for (T& element : list) get(element);
  }
  template <class T>
  void get(std::optional<T>& maybe) {
    bool present = false;
    get(present);
    maybe.reset();
    if (present) get(maybe.emplace());
  }
  template <class... T>
  void get(std::variant<T...>& choice) {
    std::uint8_t tag = 0;
    get(tag);
    if (tag >= sizeof...(T)) return fail();
    getAlternative(choice, tag, std::index_sequence_for<T...>{});
  }
  template <class Variant, std::size_t... I>
  void getAlternative(Variant& choice, std::uint8_t tag, std::index_sequence<I...>) {
    ((tag == I ? get(choice.template emplace<I>()) : void()), ...);
  }
  template <class T>
  requires std::is_class_v<T>
  void get(T& value) { serialize(*this, value); }

  std::span<const std::byte> in_;
  bool ok_ = true;
};

// Has a serialize() for both directions.
template <class T>
concept Serializable = requires(Writer& writer, Reader& reader, T& value) {
  serialize(writer, value);
  serialize(reader, value);
};

// A field and the value that it usually has.
template <class T>
struct Usual {
  T& value;
  T usual;
};
template <class T>
Usual(T&, T) -> Usual<T>;

template <class T>
bool sameBits(const T& a, const T& b) {
  if constexpr (std::is_trivially_copyable_v<T>) {
    return std::memcmp(&a, &b, sizeof a) == 0;  // not ==: -0 is not 0 here, and NaN is NaN
  } else {
    return a.empty() && b.empty();  // lists: only "empty" is usual
  }
}

// Fields that mostly have their usual value: one bit each says which do not, and only those follow.
template <class Archive, class... T>
void serializeSparse(Archive& archive, Usual<T>... field) {
  static_assert(sizeof...(T) <= 16);
  std::uint16_t present = 0;
  int bit = 0;
  if constexpr (Archive::kReading) {
    archive(present);
    auto get = [&](auto& f) {
      if (present >> bit++ & 1) {
        archive(f.value);
      } else {
        f.value = f.usual;
      }
    };
    (get(field), ...);
  } else {
    ((present |= static_cast<std::uint16_t>(!sameBits(field.value, field.usual) << bit++)), ...);
    archive(present);
    bit = 0;
    ((present >> bit++ & 1 ? archive(field.value) : void()), ...);
  }
}

template <class T>
Bytes encode(const T& value) {
  Bytes out;
  Writer{out}(value);
  return out;
}

// The value, or nothing when the bytes are not exactly one value of this type.
template <class T>
std::optional<T> decode(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  T value{};
  reader(value);
  if (!reader.ok() || reader.left() != 0) return std::nullopt;
  return value;
}

}  // namespace rayshade
