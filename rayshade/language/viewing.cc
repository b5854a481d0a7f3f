// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/viewing.h"

#include <algorithm>
#include <array>

#include "rayshade/base/error.h"
#include "rayshade/image/picture_file.h"
#include "rayshade/language/parse_member.h"

namespace rayshade {
namespace {

void readWindow(ArgumentReader& in, PictureSpec& picture) {
  std::array<std::int32_t, 4> window;
  for (std::int32_t& side : window) side = in.integer();
  picture.window = window;
}

void readCrop(ArgumentReader& in, PictureSpec& picture) {
  std::array<double, 4> crop;
  for (double& side : crop) side = std::clamp(in.number(), 0.0, 1.0);
  if (crop[0] > crop[1]) std::swap(crop[0], crop[1]);
  if (crop[2] > crop[3]) std::swap(crop[2], crop[3]);
  picture.crop = crop;
}

void readCutoff(ArgumentReader& in, Limits& limits) {
  const double r = in.number(kFactor);
  limits.cutoff = {r, r, r};
  if (!in.numberFollows()) return;
  limits.cutoff.g = in.number(kFactor);
  limits.cutoff.b = in.number(kFactor);
}

void readFilter(ArgumentReader& in, PixelFilter& filter) {
  filter.gaussian = in.accept("gauss");
  if (!filter.gaussian && !in.accept("box")) in.unexpected("`box` or `gauss`");
  filter.width = filter.gaussian ? 1.8 : 1;
  if (in.numberFollows()) filter.width = in.number(kNotNegative);
}

void readSample(ArgumentReader& in, SceneHead& head) {
  head.picture.samplesPerSide = in.integer({1, kMaxSamplesPerSide});
  if (in.accept("jitter")) head.picture.jitter = true;
  if (in.accept("nojitter")) head.picture.jitter = false;
}

void readReport(ArgumentReader& in, ReportSpec& report) {
  report.wanted = true;
  if (in.accept("verbose")) report.verbose = true;
  if (in.accept("quiet")) report.quiet = true;
  if (in.numberFollows()) report.everyRows = in.integer(kPositiveWholeNumber);
  if (in.fileNameFollows()) report.file = in.fileName();
}

// Light and air are taken over only when they have been read to their end.
void readLight(ArgumentReader& in, SceneSettings& settings) {
  const TokenPlace statement = in.subject;
  LightSource light;
  const double r = in.number(kFactor);
  light.color = {r, r, r};
  if (in.numberFollows()) {
    light.color.g = in.number(kFactor);
    light.color.b = in.number(kFactor);
  }
  if (in.accept("ambient")) {
    settings.ambient = light.color;
    return;
  }
  const Token type = in.token();
  if (in.word() != Word::light) in.unexpected("a kind of light");
  in.subject = type.place;
  in.advance();
  auto kind = parseMember<AllLights>(type.keyword.index, in);
  if (!kind) in.fail("this light gives no light");
  light.kind = std::move(*kind);
  light.castsShadows = !in.accept("noshadow");
  settings.lights.push_back(std::move(light));
  in.subject = statement;
}

// differs from rayshade4: the index of the air may have a fraction.
void readAtmosphere(ArgumentReader& in, SceneSettings& settings) {
  const TokenPlace statement = in.subject;
  double index = 1;
  if (in.numberFollows()) index = in.number(kPositive);
  std::vector<AnyEffect> effects;
  while (in.word() == Word::effect) {
    const Token type = in.token();
    in.subject = type.place;
    in.advance();
    auto effect = parseMember<AllEffects>(type.keyword.index, in);
    if (effect) effects.push_back(std::move(*effect));
  }
  settings.airIndex = index;
  settings.atmosphere = std::move(effects);
  in.subject = statement;
}

}  // namespace

bool readViewing(Word word, ArgumentReader& in, SceneHead& head) {
  Camera& camera = head.camera;
  PictureSpec& picture = head.picture;
  switch (word) {
    case Word::aperture:
      camera.aperture = in.number();
      return true;
    case Word::atmosphere:
      readAtmosphere(in, head.settings);
      return true;
    case Word::background:
      head.settings.background = in.color();
      return true;
    case Word::contrast:
      picture.contrast = in.color();
      return true;
    case Word::crop:
      readCrop(in, picture);
      return true;
    case Word::cutoff:
      readCutoff(in, head.settings.limits);
      return true;
    case Word::eyep:
      camera.eye = in.vector();
      if (!in.transforms().empty()) in.warn("transforms do not move the eye");
      return true;
    case Word::eyesep:
      camera.eyeSeparation = in.number();
      return true;
    case Word::filter:
      readFilter(in, picture.filter);
      head.filterGiven = true;
      return true;
    case Word::focaldist:
      camera.focalDistance = in.number();
      return true;
    case Word::fov:
      camera.horizontalFov = in.number(kFieldOfView);
      camera.verticalFov.reset();
      if (in.numberFollows()) camera.verticalFov = in.number(kFieldOfView);
      return true;
    case Word::framelength:
      picture.frameLength = in.number();
      return true;
    case Word::frames:
      picture.frames = in.integer(kPositiveWholeNumber);
      return true;
    case Word::lightSource:
      readLight(in, head.settings);
      return true;
    case Word::lookp:
      camera.target = in.vector();
      return true;
    case Word::maxdepth:
      head.settings.limits.maxDepth = std::max(0, in.integer());
      return true;
    case Word::outfile: {
      const std::string name = in.fileName();
      if (!formatOf(name))
        in.warn("`" + name + "` becomes a generic picture: endings are " + kPictureEndings);
      if (head.outputFile.empty()) {
        head.outputFile = name;
      } else {
        in.warn("`outfile` is ignored: the picture goes to " + head.outputFile);
      }
      return true;
    }
    case Word::report:
      readReport(in, head.report);
      return true;
    case Word::sample:
      readSample(in, head);
      return true;
    case Word::screen:
      picture.width = in.integer({1, kMaxPictureSide});
      picture.height = in.integer({1, kMaxPictureSide});
      return true;
    case Word::shadowtransp:
      head.settings.transparentShadows = !head.settings.transparentShadows;
      return true;
    case Word::shutter:
      picture.shutter = in.number();
      return true;
    case Word::starttime:
      picture.startTime = in.number();
      return true;
    case Word::up:
      camera.up = in.vector();
      return true;
    case Word::window:
      readWindow(in, picture);
      return true;
    default:
      return false;
  }
}

void checkHead(const SceneHead& head, const std::string& fileName) {
  const Camera& camera = head.camera;
  const PictureSpec& picture = head.picture;
  std::string errors;
  // `said`: the statements that it concerns.
  auto demand = [&](bool good, const std::vector<std::string>& said, const std::string& message) {
    if (good) return;
    const SourcePlace place = head.places.last(said).value_or(SourcePlace{fileName});
    errors += (errors.empty() ? "" : "\n") + describe(place) + ": error: " + message;
  };
  demand(picture.samplesPerSide >= 1 && picture.samplesPerSide <= kMaxSamplesPerSide, {"sample"},
         "a sample count of " + std::to_string(picture.samplesPerSide) + ": there are 1 to " +
             std::to_string(kMaxSamplesPerSide) + " samples along each side of a pixel");
  const std::string size = std::to_string(picture.width) + " x " + std::to_string(picture.height);
  auto sensible = [](std::int32_t side) { return side >= 1 && side <= kMaxPictureSide; };
  const bool screenGood = sensible(picture.width) && sensible(picture.height);
  demand(screenGood, {"screen"},
         "a screen of " + size + " pixels: each side has 1 to " + std::to_string(kMaxPictureSide));
  if (screenGood) {
    demand(pixelArea(picture).has_value(), {"window"},
           "the window is not inside of the screen of " + size + " pixels");
    const double vertical =
        camera.verticalFov.value_or(camera.horizontalFov * picture.height / picture.width);
    demand(camera.horizontalFov > 0 && camera.horizontalFov < 180 && vertical > 0 && vertical < 180,
           {"fov", "screen"},
           "a field of view (fov) of " + std::to_string(camera.horizontalFov) + " by " +
               std::to_string(vertical) + " degrees: both must lie between 0 and 180");
  }
  demand(picture.frames >= 1 && picture.frames <= kMostFrames, {"frames"},
         std::to_string(picture.frames) + " frames: there are 1 to " + std::to_string(kMostFrames));
  demand(picture.filter.width >= 0, {"filter"}, "the width of the filter is negative");
  demand(camera.eyeShown == Camera::Eye::middle || camera.eyeSeparation.has_value(), {"stereo"},
         "a stereo picture needs the separation of the eyes (eyesep)");
  const Vec3 view = normalize(camera.target - camera.eye);
  demand(view != Vec3{} && isFinite(view), {"eyep", "lookp"},
         "the eye (eyep) and what it looks at (lookp) are the same point");
  // A direction, not a length: the limit is an angle.
  demand(view == Vec3{} || length(cross(view, normalize(camera.up))) >= 1e-5, {"eyep", "lookp", "up"},
         "the direction of view is parallel to up");
  if (!errors.empty()) throw SceneError(errors);
}

}  // namespace rayshade
