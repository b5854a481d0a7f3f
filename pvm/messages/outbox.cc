// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/outbox.h"

#include <string_view>

namespace rayshade {

// What is open when a record begins is counted as far as it was posted since then.
void Outbox::recordPacket(Open& open, double begin) {
  const auto to = static_cast<std::int32_t>(open.to);
  std::uint32_t messages = 0;
  for (const Open::Content& content : open.contents) messages += content.messages;
  record->add({nanoseconds(begin), nanoseconds(link_.now()), EventKind::encode, 0, to, packetsTo_[to]++,
               messages, open.bytes.size()});
  for (std::uint32_t tag = 0; tag < open.contents.size(); ++tag) {
    const Open::Content& content = open.contents[tag];
    if (content.messages > 0) record->at(begin, EventKind::content, to, tag, content.messages, content.bytes);
  }
  open.contents = {};
}

namespace {

// The compiler knows the name of a type: "... [with M = rayshade::RayTask]" or "[M = rayshade::RayTask]".
template <class M>
std::string nameOf() {
  const std::string_view here = __PRETTY_FUNCTION__;
  const std::size_t begin = here.rfind("M = ") + 4;
  const std::string_view name = here.substr(begin, here.find_first_of(";]", begin) - begin);
  return std::string(name.substr(name.rfind("::") + 2));
}

}  // namespace

std::vector<std::string> messageNames() {
  std::vector<std::string> names;
  AllMessages::forEach([&]<class M>() { names.push_back(nameOf<M>()); });
  return names;
}

}  // namespace rayshade
