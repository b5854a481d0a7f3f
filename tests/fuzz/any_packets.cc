// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade/shade_task.h"
#include "pvm/trace/pyramid_task.h"
#include "pvm/trace/voxel_task.h"
#include "tests/fuzz/any_input.h"
#include "tests/support/null_link.h"

namespace rayshade {
namespace {

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

void takeAnyPackets(std::span<const std::byte> input) {
  feed<VoxelTask>(input);
  feed<PyramidTask>(input);
  feed<ShadeTask>(input);
}

}  // namespace rayshade
