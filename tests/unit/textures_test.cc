// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/support/texture_subjects.h"

namespace rayshade {
namespace {

TEST(Marble, AgreesWithTheOriginal) {
  const TextureHit hit = applied<Marble>("", hitAt(kPlace));
  EXPECT_NEAR(hit.surface.ambient.r, 0.994180356836699, kClose);
  EXPECT_EQ(hit.surface.ambient, hit.surface.diffuse);
  EXPECT_EQ(hit.surface.specular, kWhite);
}

TEST(Marble, TakesItsColoursFromAMap) {
  std::string lines;
  for (int i = 0; i < 256; ++i) lines += std::to_string(i) + " 0 " + std::to_string(255 - i) + "\n";
  const TextureFile map("map", lines);
  const TextureHit hit = applied<Marble>(map.path(), hitAt(kPlace));
  expectNear(hit.surface.diffuse, Color{253 / 255.0, 0, 2 / 255.0});  // int(255 * 0.994)
}

TEST(Wood, HasTheConstantsOfTheOriginal) {
  const TextureHit hit = applied<Wood>("", hitAt(kPlace));
  expectNear(hit.surface.diffuse, Color{0.46835412101720747, 0.33614401260547383, 0.3663087127824696});
  EXPECT_EQ(hit.surface.ambient, hit.surface.diffuse);
}

TEST(Bump, AddsScaledVectorNoiseAndNormalizes) {
  expectNear(applied<Bump>("0.6", hitAt(kPlace)).normal,
             {-0.009544967080836657, -0.05001198758339459, 0.9987030062543039});
}

TEST(Bump, ThatCancelsTheNormalLeavesIt) {
  TextureHit hit = hitAt(kPlace);
  hit.normal = normalize(vectorNoise(kPlace));
  const Vec3 before = hit.normal;
  Bump{-1 / length(vectorNoise(kPlace))}.apply(hit);
  EXPECT_NEAR(length(hit.normal), 1, kClose) << "rounding may leave a rest, but never a zero normal";
  hit.normal = before;
  Bump{std::numeric_limits<double>::infinity()}.apply(hit);
  EXPECT_EQ(hit.normal, before);
}

TEST(FbmBump, LeavesTheNormalUnnormalized) {
  expectNear(applied<FbmBump>("0.1 0.7 0.5 2 5", hitAt(kPlace)).normal,
             {0.19807095842515934, 0.11046682129464619, 1.241340250638231});
}

TEST(Windy, BlowsEverywhereOrInCatsPaws) {
  expectNear(applied<Windy>("0.3 0.5 0 0.8 4 2.1 0.6 0.5", hitAt(kPlace)).normal,
             {0.02213055871557578, 0.04430952543008535, 0.9987726990297128});
  expectNear(applied<Windy>("0.3 0.5 2 0.8 4 2.1 0.6 0.5", hitAt(kPlace)).normal,
             {0.006493792404747428, 0.006561332462089496, 0.9999573888804092});
}

TEST(Blotch, BlendsByTheNoiseAboveItsLimit) {
  Blotch blotch{0.1, {}};  // noise is 0.2163848876953125 here
  TextureHit hit = hitAt({.5, .5, .5});
  blotch.apply(hit);
  EXPECT_NEAR(hit.surface.diffuse.r, 1 - 0.1163848876953125 / 0.9, kClose);
  blotch.mix = 0.22;
  hit = hitAt({.5, .5, .5});
  blotch.apply(hit);
  EXPECT_EQ(hit.surface.diffuse, kWhite);
}

TEST(Fbm, ScalesAboveTheThresholdAndIsFlatBelow) {
  EXPECT_NEAR(applied<Fbm>("0.25 1.2 0.5 2.1 5 -0.4", hitAt(kPlace)).surface.diffuse.g, 0.7870273842961767,
              kClose);
  EXPECT_EQ(applied<Fbm>("0.25 1.2 0.5 2.1 5 0.5", hitAt(kPlace)).surface.diffuse.g, 0.25);
}

TEST(Fbm, ValuesOutsideOfTheMapTakeItsEnds) {
  const TextureFile map("map", "255 0 0\n0 255 0\n");
  EXPECT_EQ(applied<Fbm>("-5 1 0.5 2 5 9 " + map.path(), hitAt(kPlace)).surface.diffuse, (Color{1, 0, 0}));
  EXPECT_EQ(applied<Fbm>("0.005 1 0.5 2 5 9 " + map.path(), hitAt(kPlace)).surface.diffuse, (Color{0, 1, 0}));
  EXPECT_EQ(applied<Fbm>("1e30 1 0.5 2 5 9 " + map.path(), hitAt(kPlace)).surface.diffuse, kBlack);
}

TEST(Sky, IsTransparentByWhatItLacksInCloud) {
  EXPECT_NEAR(applied<Sky>("0 0.5 2 4 0.8 0.3", hitAt(kPlace)).surface.transparency, 1 - 0.45786239418353014,
              kClose);
  const TextureHit hit = applied<Sky>("2 0.5 2 4 0.8 0.3", hitAt(kPlace));
  EXPECT_NEAR(hit.surface.transparency, 1 - 0.20963797200747433, kClose);
  EXPECT_NEAR(hit.surface.ambient.b, 0.20963797200747433, kClose);
}

TEST(Sky, IsBrightForAnExponentBelowZero) {
  const TextureHit hit = applied<Sky>("-1 0.5 2 4 0.8 0.3", hitAt(kPlace));
  EXPECT_NEAR(hit.surface.ambient.b, 1 / 0.45786239418353014, kClose);
  EXPECT_NEAR(hit.surface.transparency, 1 - 1 / 0.45786239418353014, kClose);
  EXPECT_EQ(applied<Sky>("-3 0.5 2 4 0.8 0.7", hitAt(kPlace)).surface.ambient.b, 1e6);  // 0 ^ -3
}

TEST(Sky, IsFiniteForEqualThresholds) {
  for (const char* text : {"0 0.5 2 4 0.5 0.5", "1 -0.5 2 4 0.8 0.3"}) {
    const double transparency = applied<Sky>(text, hitAt(kPlace)).surface.transparency;
    EXPECT_TRUE(transparency >= 0 && transparency <= 1) << text;
  }
}

TextureHit cloudHit() {
  TextureHit hit = hitAt({0.3179993640019079, -0.8479983040050879, 0.42399915200254396});
  hit.rayOrigin = {0, -5, 1};
  hit.rayDirection = {0.07564551270007334, 0.9876758653618715, -0.13701876291231563};
  return hit;
}

TEST(Cloud, ThinsOutTowardsTheLimb) {
  const TextureHit hit = applied<Cloud>("0.7 0.5 2 6 0.2 0.5 0.3", cloudHit());
  EXPECT_NEAR(hit.surface.transparency, 0.7008013945581965, kClose);
  EXPECT_NEAR(hit.surface.ambient.r, 1 - 0.7008013945581965, kClose);
  EXPECT_NEAR(hit.surface.diffuse.r, 0.1654352516445759, kClose);
}

TEST(Cloud, IsNotThereFromInside) {
  TextureHit hit = cloudHit();
  hit.rayOrigin = {0.5, 0.5, 0.5};
  hit = applied<Cloud>("0.7 0.5 2 6 0.2 0.5 0.3", hit);
  EXPECT_EQ(hit.surface.transparency, 1);
  EXPECT_EQ(hit.surface.diffuse, kBlack);
}

TEST(Cloud, IsFiniteFromVeryFarAwayAndWithoutSoftness) {
  TextureHit hit = cloudHit();
  for (double far : {1e6, 1e9, 1e160}) {
    hit.rayOrigin = {0, -far, 0};
    const Surface seen = applied<Cloud>("0.7 0.5 2 6 0.2 0.5 0", hit).surface;
    EXPECT_TRUE(seen.transparency >= 0 && seen.transparency <= 1) << far;
    EXPECT_TRUE(std::isfinite(seen.diffuse.r)) << far;
  }
}

TEST(Mount, ColoursByHeightTurbulenceAndSlope) {
  std::string lines;
  for (int i = 0; i < 256; ++i) lines += std::to_string(i) + " 1 2\n";
  const TextureFile map("map", lines);
  TextureHit hit = hitAt({.1, .2, .3});
  hit.normal = {0.6, 0, 0.8};
  hit = applied<Mount>(map.path() + " 0.5 0.4", hit);
  expectNear(hit.surface.diffuse, Color{81 / 255.0, 1 / 255.0, 2 / 255.0});  // 81.69
  EXPECT_EQ(hit.surface.specular, hit.surface.diffuse);
  EXPECT_EQ(hit.surface.ambient, hit.surface.diffuse);
}

TEST(Gloss, StaysInTheStratumOfItsSample) {
  const int side = 4;
  for (int sample = 0; sample < side * side; ++sample) {
    TextureHit hit = hitAt({});
    hit.key = child(RandomKey{}, static_cast<std::uint64_t>(sample));
    hit.sample = sample;
    hit.plan = {side, Sampling::strata, {}};
    Gloss{0.5}.apply(hit);
    const Basis basis = basisAround({0, 0, 1});
    const Vec3 onPlane = hit.normal / hit.normal.z;
    const double x = dot(onPlane, basis.first) / 0.5, y = dot(onPlane, basis.second) / 0.5;
    EXPECT_EQ(std::floor((x + 1) / 2 * side), sample % side);
    EXPECT_EQ(std::floor((y + 1) / 2 * side), sample / side);
  }
}

TEST(Gloss, DependsOnKeyAndTurnAlone) {
  TextureHit one = hitAt({}), same = hitAt({}), later = hitAt({}), other = hitAt({});
  later.turn = 1;
  other.key = RandomKey{7};
  for (TextureHit* hit : {&one, &same, &later, &other}) Gloss{0.8}.apply(*hit);
  EXPECT_EQ(one.normal, same.normal);
  EXPECT_NE(one.normal, later.normal);
  EXPECT_NE(one.normal, other.normal);
}

TEST(Gloss, OfOneIsAPerfectMirror) { EXPECT_EQ(applied<Gloss>("1", hitAt({})).normal, (Vec3{0, 0, 1})); }

TEST(Stripe, HasStripesFlatsAndFourBevels) {
  Stripe stripe;
  stripe.width = 0.2;
  stripe.bump = 0.5;
  auto at = [&stripe](double u, double v) {
    TextureHit hit = hitAtUv(u, v);
    stripe.apply(hit);
    return hit;
  };
  EXPECT_EQ(at(0.1, 0.5).surface.diffuse, kBlack);
  EXPECT_EQ(at(3.5, -6.9).surface.diffuse, kBlack) << "wraps";
  EXPECT_EQ(at(0.1, 0.5).normal, (Vec3{0, 0, 1})) << "no bump on the stripe itself";
  EXPECT_EQ(at(0.6, 0.6).surface.diffuse, kWhite);
  EXPECT_EQ(at(0.6, 0.6).normal, (Vec3{0, 0, 1}));
  const double c = 1 / std::sqrt(1.25), s = 0.5 * c;
  expectNear(at(0.6, 0.3).normal, {0, s, c});   // bottom
  expectNear(at(0.6, 0.9).normal, {0, -s, c});  // top
  expectNear(at(0.3, 0.6).normal, {s, 0, c});   // left
  expectNear(at(0.9, 0.6).normal, {-s, 0, c});  // right
  EXPECT_EQ(at(0.9, 0.6).surface.diffuse, kWhite);
}

TEST(Fractals, RefuseARatioThatIsNotAboveZero) {
  TextArguments sky("2 0.5 0 4 0.8 0.3"), bump("0 0.7 0.5 -2 5");
  EXPECT_THROW(Sky::parse(sky), std::runtime_error);
  EXPECT_THROW(FbmBump::parse(bump), std::runtime_error);
}

// Examples with the files that they name.  The stub gives a surface without reading any words.
std::string withFiles(std::string example, const TextureFile& picture, const TextureFile& colors) {
  auto replace = [&example](const std::string& word, const std::string& by) {
    const std::size_t at = example.find(word);
    if (at != std::string::npos) example.replace(at, word.size(), by);
  };
  replace("picture.png", picture.path());
  replace("colors.map", colors.path());
  for (const char* surface : {"diffuse 0.1 0.1 0.1", "diffuse 0.7 0.1 0.1", "diffuse 0.7 0.3 0.3"})
    replace(surface, "");
  return example;
}

// Calls use(texture) for all examples of all textures.
template <class Use>
void forAllExamples(Use use) {
  const TextureFile picture("picture", "2 1\nabcdef"), colors("map", "1 2 3\n4 5 6\n");
  AllTextures::forEach([&]<class T>() {
    static_assert(Texture<T>);
    for (std::string_view example : T::examples) {
      SCOPED_TRACE(std::string(T::keyword) + " " + std::string(example));
      use(parsed<T>(withFiles(std::string(example), picture, colors)));
    }
  });
}

TEST(AllTextures, SurviveTheWireUnchanged) {
  forAllExamples([](const auto& texture) {
    const Bytes bytes = encode(AnyTexture(texture));
    const std::optional<AnyTexture> back = decode<AnyTexture>(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(encode(*back), bytes);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_FALSE(decode<AnyTexture>(std::span(bytes).first(size))) << "cut to " << size;
  });
}

TEST(AllTextures, AreFiniteEverywhere) {
  const Vec3 places[] = {{0, 0, 0}, {1, 1, 1}, {-1, 0, 0.5}, {1e7, -1e12, 3}, {1e300, 1e300, -1e300}};
  forAllExamples([&places](const auto& texture) {
    for (Vec3 position : places) {
      TextureHit hit = hitAt({});
      TexturePlace place;
      place.position = position;
      place.rayOrigin = {3, 4, 5};
      place.rayDirection = {0, 0, -2};
      place.geometricNormal = {0, 0, 1};
      applyTexture(texture, hit, place, [](Vec3 p) { return MappedCoordinates{p.x, p.y, {}, {}}; });
      EXPECT_TRUE(isFinite(hit.normal)) << position.x;
      EXPECT_GT(length(hit.normal), 0) << position.x;
      EXPECT_TRUE(std::isfinite(largest(hit.surface.diffuse))) << position.x;
      EXPECT_TRUE(std::isfinite(hit.surface.transparency)) << position.x;
      EXPECT_EQ(hit.turn, 1u);
    }
  });
}

}  // namespace
}  // namespace rayshade
