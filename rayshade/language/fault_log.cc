// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/fault_log.h"

#include <cctype>

namespace rayshade {
namespace {

constexpr std::uint64_t kMostOfAKind = 3;  // warnings

// Without its numbers and quotes.
std::string fixedTextOf(const std::string& text) {
  std::string fixed;
  bool quoted = false;
  for (const char c : text) {
    if (c == '`') quoted = !quoted;
    if (!quoted && std::isdigit(static_cast<unsigned char>(c)) == 0) fixed += c;
  }
  return fixed;
}

}  // namespace

std::string FaultLog::message(const TokenPlace& place, std::string_view kind, const std::string& text) {
  std::string lines = describe(tokens_.describe(place)) + ": ";
  lines += kind;
  lines += ": " + text + "\n" + tokens_.excerpt(place);
  lines.pop_back();
  return lines;
}

bool FaultLog::worthSaying(const std::string& text) {
  if (!warn_) return false;
  Kind& kind = kinds_[fixedTextOf(text)];
  if (kind.count == 0) kind.first = text;
  return ++kind.count <= kMostOfAKind;
}

void FaultLog::warn(const TokenPlace& place, const std::string& text) {
  if (worthSaying(text)) warn_(message(place, "warning", text));
}

void FaultLog::warn(const std::string& text, const std::string& message) {
  if (worthSaying(text)) warn_(message);
}

void FaultLog::finish() {
  for (const auto& [fixed, kind] : kinds_) {
    if (kind.count > kMostOfAKind)
      warn_("... and " + std::to_string(kind.count - kMostOfAKind) + " more of this kind: " + kind.first);
  }
  kinds_.clear();
}

void FaultLog::add(const Fault& fault) {
  wrong_ = fault.place.offset;
  if (!errors_.empty()) errors_ += "\n";
  errors_ += message(fault.place, "error", fault.message);
  if (++count_ == kMostErrors || fault.hopeless) throw Enough{};
}

}  // namespace rayshade
