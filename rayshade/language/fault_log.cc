// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/fault_log.h"

namespace rayshade {
namespace {

constexpr int kMostErrors = 20;

}  // namespace

std::string FaultLog::message(const TokenPlace& place, std::string_view kind, const std::string& text) {
  std::string lines = describe(tokens_.describe(place)) + ": ";
  lines += kind;
  lines += ": " + text + "\n" + tokens_.excerpt(place);
  lines.pop_back();
  return lines;
}

void FaultLog::warn(const TokenPlace& place, const std::string& text) {
  if (warn_) warn_(message(place, "warning", text));
}

void FaultLog::add(const Fault& fault) {
  wrong_ = fault.place.offset;
  if (!errors_.empty()) errors_ += "\n";
  errors_ += message(fault.place, "error", fault.message);
  if (++count_ == kMostErrors || fault.hopeless) throw Enough{};
}

}  // namespace rayshade
