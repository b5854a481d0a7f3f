// A vector that keeps its first N elements inside itself.
//
// Most hits ask a handful of lights; an allocation for each of them would cost more than the answer.
// For trivially copyable types only.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace rayshade {

template <class T, std::size_t N>
class InlineVector {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  InlineVector() = default;
  // Only what is there is copied.
  InlineVector(const InlineVector& from) : size_(from.size_), outside_(from.outside_) { copyInside(from); }
  InlineVector(InlineVector&& from) noexcept : size_(from.size_), outside_(std::move(from.outside_)) {
    copyInside(from);
    from.clear();
  }
  InlineVector& operator=(const InlineVector& from) {
    size_ = from.size_;
    outside_ = from.outside_;
    copyInside(from);
    return *this;
  }
  InlineVector& operator=(InlineVector&& from) noexcept {
    size_ = from.size_;
    outside_ = std::move(from.outside_);
    copyInside(from);
    if (this != &from) from.clear();
    return *this;
  }
  explicit InlineVector(std::size_t size, T value = T{}) { assign(size, value); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return size_ <= N ? inside_.elements.data() : outside_.data(); }
  const T* data() const { return size_ <= N ? inside_.elements.data() : outside_.data(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  T& back() { return data()[size_ - 1]; }
  const T& back() const { return data()[size_ - 1]; }

  // A new element at the end, to be filled in.
  T& emplace_back() {
    if (size_ < N) return inside_.elements[size_++] = T{};
    push_back(T{});
    return outside_.back();
  }
  void push_back(const T& value) {
    if (size_ < N) {
      inside_.elements[size_] = value;
    } else {
      if (size_ == N) outside_.assign(inside_.elements.begin(), inside_.elements.end());
      outside_.push_back(value);
    }
    ++size_;
  }
  void pop_back() {
    if (size_ > N) outside_.pop_back();
    if (--size_ == N) {
      std::copy(outside_.begin(), outside_.end(), inside_.elements.begin());
      outside_.clear();
    }
  }
  void assign(std::size_t size, T value = T{}) {
    clear();
    if (size <= N) {
      for (std::size_t i = 0; i < size; ++i) inside_.elements[i] = value;
    } else {
      outside_.assign(size, value);
    }
    size_ = size;
  }
  void clear() {
    size_ = 0;
    outside_.clear();
  }

 private:
  void copyInside(const InlineVector& from) {
    if (size_ <= N) std::copy_n(from.inside_.elements.begin(), size_, inside_.elements.begin());
  }

  std::size_t size_ = 0;
  // Elements begin when they are put in: clearing room for all N would take longer than most uses.
  union Room {
    Room() {}
    std::array<T, N> elements;
  } inside_;
  std::vector<T> outside_;
};

// On the wire like a vector: a count, checked against the bytes left, and the elements.
template <class Archive, class T, std::size_t N>
void serialize(Archive& archive, InlineVector<T, N>& list) {
  auto size = static_cast<std::uint32_t>(list.size());
  archive(size);
  if constexpr (Archive::kReading) {
    list.clear();
    if (size > archive.left() / sizeof(T)) return archive.fail();
    for (std::uint32_t i = 0; i < size; ++i) {
      T element{};
      archive(element);
      list.push_back(element);
    }
  } else {
    for (T& element : list) archive(element);
  }
}

}  // namespace rayshade
