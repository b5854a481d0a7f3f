// What is known everywhere: the lights, the air, the limits, and how the picture is taken.
//
// A few hundred bytes whatever the size of the scene; every task has it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rayshade/atmosphere/all.h"
#include "rayshade/base/color.h"
#include "rayshade/base/error.h"
#include "rayshade/lights/all.h"
#include "rayshade/sampling/picture_spec.h"

namespace rayshade {

struct Limits {
  std::int32_t maxDepth = 5;          // of a ray; the eye's rays have depth 0
  Color cutoff{0.002, 0.002, 0.002};  // a secondary ray that weighs no more than this is not traced
};

struct SceneSettings {
  std::vector<LightSource> lights;  // in the order of the file; no ambient lights
  Color ambient = kWhite;           // `light I ambient`
  Color background = kBlack;
  double airIndex = 1;                // of refraction, outside of everything
  std::vector<AnyEffect> atmosphere;  // in the order of the file
  Limits limits;
  bool shadows = true;             // -n turns them off
  bool transparentShadows = true;  // `shadowtransp` and -o toggle
  SamplePlan samples;              // as those of the picture
};

struct Camera {
  Vec3 eye{0, -10, 0}, target{0, 0, 0}, up{0, 0, 1};  // world
  double horizontalFov = 45;                          // degrees
  std::optional<double> verticalFov;                  // degrees; else horizontalFov * height / width
  double aperture = 0;                                // half width of the (square) lens; 0: a pinhole
  std::optional<double> focalDistance;                // else |target - eye|
  std::optional<double> eyeSeparation;
  enum class Eye : std::uint8_t { middle, left, right } eyeShown = Eye::middle;
};

// How the scene wants its report.
struct ReportSpec {
  bool wanted = false, verbose = false, quiet = false;
  std::int32_t everyRows = 10;
  std::string file;  // empty: standard error
};

// Where the statements stand that are no items, the last one of each keyword (or the option that overrides
// it): for messages about what they say together.
class StatementPlaces {
 public:
  void set(const std::string& keyword, const SourcePlace& place) {
    std::erase_if(places_, [&](const auto& known) { return known.first == keyword; });
    places_.emplace_back(keyword, place);
  }
  // Of the last statement with one of these keywords.
  std::optional<SourcePlace> last(const std::vector<std::string>& keywords) const {
    for (auto at = places_.rbegin(); at != places_.rend(); ++at)
      if (std::find(keywords.begin(), keywords.end(), at->first) != keywords.end()) return at->second;
    return std::nullopt;
  }

 private:
  std::vector<std::pair<std::string, SourcePlace>> places_;  // in their order
};

// Everything in a scene file that is not an item.
struct SceneHead {
  SceneSettings settings;
  Camera camera;
  PictureSpec picture;
  ReportSpec report;
  std::string outputFile;    // `outfile`; empty: not said
  bool filterGiven = false;  // the file has a `filter` statement
  StatementPlaces places;
};

// Tells the settings what the picture's samples are, and who uses which of their coordinates.
inline void agreeOnSamples(SceneHead& head) {
  const auto isWide = [](const LightSource& light) { return isRandom(light); };
  head.picture.uses = sampleUses(
      head.camera.aperture > 0, std::any_of(head.settings.lights.begin(), head.settings.lights.end(), isWide),
      head.picture.shutter > 0);
  head.settings.samples = head.picture.plan();
}

template <class Archive>
void serialize(Archive& archive, Limits& l) {
  archive(l.maxDepth, l.cutoff);
}
template <class Archive>
void serialize(Archive& archive, SceneSettings& s) {
  archive(s.lights, s.ambient, s.background, s.airIndex, s.atmosphere, s.limits, s.shadows,
          s.transparentShadows, s.samples);
}

}  // namespace rayshade
