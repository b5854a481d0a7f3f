// Images that come to a task: what fits is answered, what is forged is refused and counted.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/image_copies.h"

#include <gtest/gtest.h>

#include "tests/support/null_link.h"
#include "tests/support/pixels.h"

namespace rayshade {
namespace {

constexpr TaskId kHost{1};

struct ImageCopiesOfATask : testing::Test {
  std::uint64_t refused() const { return context.outbox.traffic.refused; }
  void send(std::uint64_t offset, const Pixels& bytes) { send(image, offset, bytes); }
  void send(const Image& of, std::uint64_t offset, const Pixels& bytes) {
    copies.take(kHost, ImagePiece{of, offset, bytes}, context);
  }
  // What an item gets for pixels.
  Pixels filled(const Image& mentioned) {
    ImageTexture texture;
    texture.image = std::make_shared<const Image>(mentioned);
    NodeItem node;
    node.node.textures.push_back({texture, {}});
    std::vector<Item> items{node};
    if (!copies.fill(items)) return {};
    return pixelsOf(*std::get<ImageTexture>(std::get<NodeItem>(items[0]).node.textures[0].texture).image);
  }

  NullLink link;
  TaskContext context{link};
  ImageCopies copies;
  Image image{ImageId{5}, 2, 1, 3, {}, {}};
};

TEST_F(ImageCopiesOfATask, PiecesMakeAnImageAndTheLastIsAnswered) {
  send(0, {1, 2, 3, 4});
  EXPECT_EQ(filled(image), Pixels{});
  const std::uint64_t before = context.outbox.traffic.messagesOut;
  send(4, {5, 6});
  EXPECT_EQ(context.outbox.traffic.messagesOut, before + 2) << "taken, and the whole is there";
  EXPECT_EQ(filled(image), (Pixels{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(refused(), 0u);
}

TEST_F(ImageCopiesOfATask, PiecesThatDoNotFollowAreRefused) {
  send(4, {5, 6});  // nothing before it
  send(0, {1, 2, 3, 4});
  send(3, {4, 5, 6});
  send(0, {1, 2, 3, 4});
  send(4, {5, 6, 7});  // more than there is
  send(0, {});
  Image other = image;
  other.height = 1'000'000;
  send(0, {1, 2, 3, 4});
  send(other, 4, {5, 6});
  EXPECT_EQ(refused(), 5u);
  EXPECT_EQ(filled(image), Pixels{});
}

TEST_F(ImageCopiesOfATask, APlaceIsMappedIfThePixelsAreThere) {
  SharedBytes shared;
  image.place = shared.begin();
  shared.write(image.place.offset, Pixels{6, 5, 4, 3, 2, 1});
  copies.take(kHost, ImagePlace{image}, context);
  EXPECT_EQ(filled(image), (Pixels{6, 5, 4, 3, 2, 1}));
  Image larger = image;
  larger.id = ImageId{6};
  larger.width = 3;
  copies.take(kHost, ImagePlace{larger}, context);
  EXPECT_EQ(filled(larger), Pixels{});
  larger.id = image.id;
  EXPECT_EQ(filled(larger), Pixels{}) << "an item that claims another size";
}

}  // namespace
}  // namespace rayshade
