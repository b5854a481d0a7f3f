// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/text_window.h"

#include <cstring>

namespace rayshade {
namespace {

constexpr std::size_t kWindow = std::size_t{1} << 18;   // bytes
constexpr std::size_t kHistory = std::size_t{1} << 15;  // bytes kept behind the reading position

}  // namespace

TextWindow::TextWindow(ReadText read) : read_(std::move(read)), window_(kWindow + 1) {
  next = end_ = window_.data();
}

bool TextWindow::refill() {
  if (all_) return false;
  // Drop what lies far enough behind, then fill up.
  char* const begin = window_.data();
  const auto done = static_cast<std::size_t>(next - begin);
  const std::size_t drop = done > kHistory ? done - kHistory : 0;
  const auto held = static_cast<std::size_t>(end_ - begin) - drop;
  std::memmove(begin, begin + drop, held);
  start_ += drop;
  next -= drop;
  const std::size_t got = held < kWindow ? read_(begin + held, kWindow - held) : 0;
  all_ = got == 0;
  end_ = begin + held + got;
  begin[held + got] = '\0';
  return got > 0;
}

void TextWindow::needAhead(std::size_t count) {
  while (left() < count && refill()) {
  }
}

}  // namespace rayshade
