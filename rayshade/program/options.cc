// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "rayshade/language/viewing.h"

namespace rayshade {

namespace {

// Not CLI::Range, which lets through what is not a number.
CLI::Validator within(double low, double high) {
  const std::string range = CLI::detail::to_string(low) + " to " + CLI::detail::to_string(high);
  return CLI::Validator(
      [=](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : text + " is not a number from " + range;
      },
      range);
}

}  // namespace

void declareOptions(CLI::App& app, Options& o) {
  app.set_help_flag("-h,--help", "show this and leave");
  app.option_defaults()->multi_option_policy(
      CLI::MultiOptionPolicy::TakeLast);  // said twice: the last counts
  const std::string input = "The scene", picture = "The picture", quality = "Speed against quality",
                    talk = "Messages";
  app.add_option("scene", o.parse.fileName, "scene file in the Rayshade language; none or -: standard input");
  app.add_flag_callback(
         "-u", [&o] { o.parse.preprocess = !o.parse.preprocess; }, "do not run the C preprocessor")
      ->group(input);
  app.add_option("-P", o.parse.preprocessorArguments, "arguments for the preprocessor, e.g. -P '-DBIG'")
      ->group(input);
  app.add_flag("-f", o.parse.flipTriangleNormals, "flip the normals of triangles and polygons")->group(input);

  app.add_option("-O", o.outputFile,
                 "output file: .png .ppm .pfm (linear floats), anything else the generic format; - is "
                 "standard output")
      ->group(picture);
  app.add_option("-R", o.resolution, "width and height in pixels")
      ->expected(2)
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-W", o.window, "render only the pixels x0 x1 y0 y1")
      ->expected(4)
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-X", o.crop, "crop to left right bottom top, shares of the window")
      ->expected(4)
      ->check(within(0.0, 1.0))
      ->allow_extra_args(false)
      ->group(picture);
  app.add_option("-G", o.gamma, "gamma of the output (1: linear)")
      ->check(within(0.01, 100.0))
      ->group(picture);
  app.add_flag("--16", o.sixteenBit, "PNG with 16 bits a channel")->group(picture);
  app.add_flag("-l", o.leftEye, "render the left eye of a stereo pair")->group(picture);
  app.add_flag("-r", o.rightEye, "render the right eye")->group(picture);
  app.add_option("-E", o.eyeSeparation, "distance between the eyes")->group(picture);
  app.add_option("-A", o.firstFrame, "first frame of the animation")->group(picture);
  app.add_option("-N", o.frames, "number of frames")->group(picture);

  app.add_option("-S", o.samples, "samples along each side of a pixel, 1 to 8")->group(quality);
  app.add_option("-T", o.contrast, "contrast r g b above which a pixel gets all of its samples")
      ->expected(3)
      ->check(within(0.0, 1e9))
      ->allow_extra_args(false)
      ->group(quality);
  app.add_option("-C", o.cutoff, "weight r g b below which no ray is sent")
      ->expected(3)
      ->check(within(0.0, 1e9))
      ->allow_extra_args(false)
      ->group(quality);
  app.add_option("-D", o.maxDepth, "largest number of reflections and refractions in a row")->group(quality);
  app.add_flag("-j", o.toggleJitter, "sample the corners of the cells instead of jittering")->group(quality);
  app.add_flag("-g", o.gaussian, "Gaussian pixel filter, unless the scene names one")->group(quality);
  app.add_flag("-n", o.noShadows, "no shadows")->group(quality);
  app.add_flag("-o", o.opaqueShadows, "transparent objects cast full shadows")->group(quality);
  app.add_flag("-p", o.preview, "preview: no shadows, no reflections, one sample in a pixel")->group(quality);
  app.add_flag("-s", o.toggleShadowCache, "accepted for old command lines; there is no such cache")
      ->group(quality);
  app.add_option("--seed", o.seed, "another set of random numbers")->group(quality);

  app.add_flag("-q", o.quiet, "no progress, no advice")->group(talk);
  app.add_flag("-v", o.verbose, "report at the end")->group(talk);
  app.add_option("-V", o.verboseFile, "report into a file")->group(talk);
  app.add_option("-F", o.reportEvery, "a line that stays every so many rows")->group(talk);
  app.footer("Exit status: 0, 1 for a bad scene or file, 2 for a bad command line.");
}

std::optional<int> readCommandLine(int argc, char** argv, Options& options, bool& plan) {
  CLI::App app("rayshade - renders a scene in the language of Rayshade 4", "rayshade");
  declareOptions(app, options);
  app.add_flag("--plan", plan, "render nothing: print what the scene uses, and what is switched off")
      ->group("Messages");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

void applyOptions(const Options& o, SceneHead& head) {
  PictureSpec& picture = head.picture;
  SceneSettings& settings = head.settings;
  if (o.resolution.size() == 2) {
    picture.width = o.resolution[0];
    picture.height = o.resolution[1];
  }
  if (o.window.size() == 4) picture.window = {o.window[0], o.window[1], o.window[2], o.window[3]};
  if (o.crop.size() == 4) picture.crop = {o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
  if (o.cutoff.size() == 3) settings.limits.cutoff = {o.cutoff[0], o.cutoff[1], o.cutoff[2]};
  if (o.contrast.size() == 3) picture.contrast = {o.contrast[0], o.contrast[1], o.contrast[2]};
  if (o.samples) picture.samplesPerSide = std::max(1, *o.samples);
  if (o.maxDepth) settings.limits.maxDepth = std::max(0, *o.maxDepth);
  if (o.frames) picture.frames = *o.frames;
  if (o.firstFrame) picture.firstFrame = *o.firstFrame;
  if (o.gamma) picture.gamma = *o.gamma;
  if (o.eyeSeparation) head.camera.eyeSeparation = *o.eyeSeparation;
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
  settings.samplesPerSide = picture.samplesPerSide;
}

std::string sceneName(const Options& options) {
  const std::string& name = options.parse.fileName;
  return name.empty() || name == "-" ? "standard input" : name;
}

std::int32_t rowsBetweenLines(const Options& options, const SceneHead& head) {
  if (options.quiet || head.report.quiet) return 0;
  if (options.reportEvery) return std::max(1, *options.reportEvery);
  return head.report.wanted ? head.report.everyRows : 0;
}

bool reportWanted(const Options& options, const SceneHead& head) {
  return options.verbose || !options.verboseFile.empty() || (head.report.wanted && head.report.verbose);
}

std::string reportFile(const Options& options, const SceneHead& head) {
  if (!reportWanted(options, head)) return {};
  return options.verboseFile.empty() ? head.report.file : options.verboseFile;
}

std::string chooseOutput(const Options& options, const SceneHead& head) {
  if (options.outputFile.empty()) return head.outputFile;
  if (!head.outputFile.empty() && options.parse.warn)
    options.parse.warn(sceneName(options) + ": warning: outfile " + head.outputFile + " is ignored: -O " +
                       options.outputFile);
  return options.outputFile;
}

std::string frameFile(const std::string& name, std::int32_t frame, std::int32_t frames) {
  if (frames <= 1 || name.empty() || name == "-") return name;
  char number[16];
  std::snprintf(number, sizeof number, ".%04d", frame);
  const std::size_t slash = name.find_last_of('/');
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return name + number;
  return name.substr(0, dot) + number + name.substr(dot);
}

}  // namespace rayshade
