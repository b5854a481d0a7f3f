// Packets that anybody may have made, into the tasks: they never crash, hang or take more memory than the bytes
// justify.
//
// The input is a row of packets, each with its size (16 bits, little-endian) in front.
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include "pvm/pyramid_task.h"
#include "pvm/shade_task.h"
#include "pvm/voxel_task.h"
#include "tests/support/null_link.h"

namespace {

using namespace rayshade;

template <class Task>
void feed(std::span<const std::byte> input) {
  NullLink link;
  Task task(link);
  while (input.size() >= 2 && !task.finished()) {
    const std::size_t wanted = static_cast<std::size_t>(input[0]) | static_cast<std::size_t>(input[1]) << 8;
    input = input.subspan(2);
    const std::size_t size = std::min(wanted, input.size());
    task.receive({LinkEvent::Kind::packet, TaskId{1}, "",
                  Bytes(input.begin(), input.begin() + static_cast<long>(size))});
    input = input.subspan(size);
    for (int slice = 0; slice < 8 && task.work(0); ++slice) task.flush();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  feed<VoxelTask>(input);
  feed<PyramidTask>(input);
  feed<ShadeTask>(input);
  return 0;
}
