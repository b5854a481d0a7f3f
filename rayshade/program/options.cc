// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/options.h"

#include <limits>

#include "rayshade/base/crew.h"
#include "rayshade/language/viewing.h"
#include "rayshade/program/option_values.h"

namespace rayshade {

namespace {

constexpr std::int32_t kLargestDepth = 100'000'000;  // memory ends before
constexpr int kMostThreads = 1024;
constexpr double kHuge = 1e9;

}  // namespace

unsigned threadsOf(const Options& options) { return options.threads.value_or(coreCount()); }

void declareOptions(CLI::App& app, Options& o) {
  // CLI11 lets too few values through where the last ones count.
  app.parse_complete_callback([&app] {
    for (const CLI::Option* option : app.get_options()) {
      const auto wanted = static_cast<std::size_t>(std::max(1, option->get_expected_min()));
      if (option->count() % wanted != 0)
        throw CLI::ArgumentMismatch(option->get_name() + " takes " + std::to_string(wanted) + " values");
    }
  });
  app.option_defaults()->multi_option_policy(
      CLI::MultiOptionPolicy::TakeLast);  // said twice: the last counts
  const std::string input = "The scene", picture = "The picture", quality = "Speed against quality",
                    talk = "Messages";
  app.add_option("scene", o.parse.fileName, "scene file in the Rayshade language; none or -: standard input")
      ->type_name(kScene)
      ->check(notEmpty())
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  app.add_flag_callback(
         "-u", [&o] { o.parse.preprocess = !o.parse.preprocess; }, "do not run the C preprocessor")
      ->group(input);
  app.add_option("-P", o.parse.preprocessorArguments, "arguments for the preprocessor, e.g. -P '-DBIG'")
      ->group(input);
  app.add_flag("-f", o.parse.flipTriangleNormals, "flip the normals of triangles and polygons")->group(input);

  app.add_option("-O", o.outputFile,
                 "output file: .png .ppm .pfm (linear floats) .mtv (generic, as without an ending); - is "
                 "standard output")
      ->type_name(kFile)
      ->check(notEmpty())
      ->check(pictureFile())
      ->group(picture);
  app.add_option("-R", o.resolution, "width and height in pixels")
      ->expected(2)
      ->check(wholeNumberFrom(1, kMaxPictureSide))
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-W", o.window, "render only the pixels x0 x1 y0 y1")
      ->expected(4)
      ->check(wholeNumberFrom(0, kMaxPictureSide - 1))
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-X", o.crop, "crop to left right bottom top, shares of the window")
      ->expected(4)
      ->transform(numberFrom(0, 1))
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-G", o.gamma, "gamma of the output (1: linear)")
      ->transform(numberFrom(0.01, 100))
      ->group(picture);
  app.add_flag("--16", o.sixteenBit, "PNG with 16 bits a channel")->group(picture);
  app.add_flag("-l", o.leftEye, "render the left eye of a stereo pair")->group(picture);
  app.add_flag("-r", o.rightEye, "render the right eye")->group(picture);
  app.add_option("-E", o.eyeSeparation, "distance between the eyes")
      ->transform(numberFrom(0, kHuge))
      ->group(picture);
  app.add_option("-A", o.firstFrame, "first frame of the animation")
      ->check(wholeNumberFrom(0, kMostFrames))
      ->group(picture);
  app.add_option("-N", o.frames, "number of frames")->check(wholeNumberFrom(1, kMostFrames))->group(picture);

  app.add_option("--threads", o.threads, "threads that trace (default: as many as there are cores)")
      ->check(wholeNumberFrom(1, kMostThreads))
      ->group(quality);
  app.add_option("-S", o.samples, "samples along each side of a pixel")
      ->check(wholeNumberFrom(1, kMaxSamplesPerSide))
      ->group(quality);
  app.add_option(
         "--sampling", o.sampling,
         "how samples are spread: nets (evenly in all that is random at once), strata (as rayshade 4 does)")
      ->check(CLI::IsMember({"nets", "strata"}))
      ->group(quality);
  app.add_option(
         "--refine", o.refinement,
         "which pixels get all of their samples: neighbours (where these differ), crosses (as rayshade 4 "
         "has it; loses light of small things), all")
      ->check(CLI::IsMember({"neighbours", "crosses", "all"}))
      ->group(quality);
  app.add_option("-T", o.contrast, "contrast r g b above which pixels are refined; 0 0 0: all of them")
      ->expected(3)
      ->transform(numberFrom(0, kHuge))
      ->allow_extra_args(false)
      ->group(quality);
  app.add_option("-C", o.cutoff, "weight r g b below which no ray is sent")
      ->expected(3)
      ->transform(numberFrom(0, kHuge))
      ->allow_extra_args(false)
      ->group(quality);
  app.add_option("-D", o.maxDepth, "largest number of reflections and refractions in a row")
      ->check(wholeNumberFrom(0, kLargestDepth))
      ->group(quality);
  app.add_flag("-j", o.toggleJitter, "sample the corners of the cells instead of jittering")->group(quality);
  app.add_flag("-g", o.gaussian, "Gaussian pixel filter, unless the scene names one")->group(quality);
  app.add_flag("-n", o.noShadows, "no shadows")->group(quality);
  app.add_flag("-o", o.opaqueShadows, "transparent objects cast full shadows")->group(quality);
  app.add_flag("-p", o.preview, "preview: no shadows, no reflections, one sample in a pixel")->group(quality);
  app.add_flag("-s", o.toggleShadowCache, "accepted for old command lines; there is no such cache")
      ->group(quality);
  app.add_option("--seed", o.seed, "another set of random numbers")
      ->check(wholeNumberFrom<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max()))
      ->group(quality);

  app.add_flag("-q", o.quiet, "no progress, no advice")->group(talk);
  app.add_flag("-v", o.verbose, "report at the end")->group(talk);
  app.add_option("-V", o.verboseFile, "report into a file")->type_name(kFile)->check(notEmpty())->group(talk);
  app.add_option("--events", o.eventsFile, "note what was done when, for rayshade-events")
      ->type_name(kFile)
      ->check(notEmpty())
      ->group(talk);
  app.add_option("-F", o.reportEvery, "a line that stays every so many rows")
      ->check(wholeNumberFrom(1, kMaxPictureSide))
      ->group(talk);
  app.footer("Exit status: 0, 1 for a bad scene or file, 2 for a bad command line.");
}

void applyOptions(const Options& o, SceneHead& head) {
  PictureSpec& picture = head.picture;
  SceneSettings& settings = head.settings;
  // What contradicts the scene is said of the option.
  auto said = [&head](const char* keyword, const char* option) {
    head.places.set(keyword, SourcePlace{std::string("option ") + option});
  };
  if (o.resolution.size() == 2) {
    said("screen", "-R");
    picture.width = o.resolution[0];
    picture.height = o.resolution[1];
  }
  if (o.window.size() == 4) {
    said("window", "-W");
    picture.window = {o.window[0], o.window[1], o.window[2], o.window[3]};
  }
  if (o.crop.size() == 4) picture.crop = {o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
  if (o.cutoff.size() == 3) settings.limits.cutoff = {o.cutoff[0], o.cutoff[1], o.cutoff[2]};
  if (o.contrast.size() == 3) picture.contrast = {o.contrast[0], o.contrast[1], o.contrast[2]};
  if (o.samples) picture.samplesPerSide = *o.samples;
  picture.sampling = o.sampling == "strata" ? Sampling::strata : Sampling::nets;
  if (o.refinement == "neighbours") picture.refinement = Refinement::neighbours;
  if (o.refinement == "crosses") picture.refinement = Refinement::crosses;
  if (o.refinement == "all") picture.refinement = Refinement::all;
  if (o.maxDepth) settings.limits.maxDepth = *o.maxDepth;
  if (o.frames) picture.frames = *o.frames;
  if (o.firstFrame) picture.firstFrame = *o.firstFrame;
  if (o.gamma) picture.gamma = *o.gamma;
  if (o.eyeSeparation) head.camera.eyeSeparation = *o.eyeSeparation;
  if (o.leftEye || o.rightEye) said("stereo", o.leftEye ? "-l" : "-r");
  if (o.leftEye) head.camera.eyeShown = Camera::Eye::left;
  if (o.rightEye) head.camera.eyeShown = Camera::Eye::right;
  if (o.gaussian && !head.filterGiven) picture.filter = {true, 1.8};
  if (o.toggleJitter) picture.jitter = false;  // whatever the file says
  if (o.noShadows) settings.shadows = false;
  if (o.opaqueShadows) settings.transparentShadows = !settings.transparentShadows;
  if (o.preview) {
    settings.shadows = false;
    settings.limits.maxDepth = 0;
    picture.samplesPerSide = 1;
    picture.jitter = true;
  }
  checkHead(head, sceneName(o));
  agreeOnSamples(head);
}

std::string sceneName(const Options& options) {
  const std::string& name = options.parse.fileName;
  return name.empty() || name == "-" ? "<stdin>" : name;
}

std::int32_t rowsBetweenLines(const Options& options, const SceneHead& head) {
  if (options.quiet || head.report.quiet) return 0;
  if (options.reportEvery) return *options.reportEvery;
  return head.report.wanted ? head.report.everyRows : 0;
}

bool reportWanted(const Options& options, const SceneHead& head) {
  return options.verbose || !options.verboseFile.empty() || (head.report.wanted && head.report.verbose);
}

std::string reportFile(const Options& options, const SceneHead& head) {
  if (!reportWanted(options, head)) return {};
  return options.verboseFile.empty() ? head.report.file : options.verboseFile;
}

}  // namespace rayshade
