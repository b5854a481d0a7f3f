// The program `rayshade-error`: how far a picture is from a reference.
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "rayshade/base/interruption.h"
#include "rayshade/image/picture_error.h"
#include "rayshade/program/command_line.h"
#include "rayshade/program/option_values.h"
#include "rayshade/program/run.h"

namespace {

using namespace rayshade;

struct Wishes {
  std::string reference, picture, difference;
  bool json = false;
};

void writeDifference(const std::string& file, const PictureError& error, std::int32_t width,
                     std::int32_t height) {
  listenForInterruption();  // from here on something is to be put away
  PictureWriter writer(file, width, height);
  std::vector<Color> row;
  for (double flip : error.flipOfPixels) {
    checkInterruption();
    row.push_back({flip, flip, flip});
    if (row.size() < static_cast<std::size_t>(width)) continue;
    writer.row(row);
    row.clear();
  }
  writer.finish();
}

void print(const PictureError& error, bool json) {
  const auto& [x, y, mrse, reference, picture] = error.worst;
  if (json) {
    std::printf("{\"mrse\": %.9g, \"rmse\": %.9g, \"flip\": %.9g,\n", error.mrse, error.rmse, error.flip);
    std::printf(
        " \"worst\": {\"x\": %d, \"y\": %d, \"mrse\": %.9g, \"reference\": [%.9g, %.9g, %.9g], \"picture\": "
        "[%.9g, %.9g, %.9g]}}\n",
        x, y, mrse, reference[0], reference[1], reference[2], picture[0], picture[1], picture[2]);
    return;
  }
  std::printf("mrse   %.6g\nrmse   %.6g\nflip   %.6g\n", error.mrse, error.rmse, error.flip);
  std::printf("worst  pixel %d %d: mrse %.6g, reference %.6g %.6g %.6g, picture %.6g %.6g %.6g\n", x, y, mrse,
              reference[0], reference[1], reference[2], picture[0], picture[1], picture[2]);
}

int run(const Wishes& wishes) {
  const Picture reference = readPicture(wishes.reference), picture = readPicture(wishes.picture);
  const std::string problem = whyNotComparable(reference, picture);
  if (!problem.empty()) throw std::runtime_error(wishes.reference + ", " + wishes.picture + ": " + problem);
  const PictureError error = pictureError(reference, picture);
  if (!wishes.difference.empty()) writeDifference(wishes.difference, error, picture.width, picture.height);
  print(error, wishes.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("rayshade-error - how far a picture is from a reference", "rayshade-error");
  Wishes wishes;
  app.add_option("reference", wishes.reference, "what it should be: .pfm (best), .ppm, .png or generic")
      ->type_name(kFile)
      ->check(notEmpty())
      ->required();
  app.add_option("picture", wishes.picture, "what is judged, of the same size")
      ->type_name(kFile)
      ->check(notEmpty())
      ->required();
  app.add_flag("--json", wishes.json, "the figures as JSON");
  app.add_option("--difference", wishes.difference,
                 "write a picture of the FLIP error of each pixel, black 0 to white 1")
      ->type_name(kFile)
      ->check(notEmpty())
      ->check(pictureFile());
  app.footer(
      "mrse: mean of (v - r)^2 / (|r| + 0.01)^2; rmse: root of the mean of (v - r)^2; flip: mean of "
      "LDR-FLIP, what a "
      "viewer sees.\nLight is linear: of files with levels only those written with gamma 1 mean what they "
      "say.\n"
      "Exit status: 0, 1 for bad files, 2 for a bad command line.");
  if (const std::optional<int> status = readCommandLine(app, argc, argv)) return *status;
  return runProgram(
      "rayshade-error", [&] { return run(wishes); }, [] { return "for the pictures: " + memoryOfProcess(); });
}
