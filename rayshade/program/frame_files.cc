// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/frame_files.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "rayshade/program/run.h"

namespace rayshade {
namespace {

std::string chooseOutput(const Options& options, const SceneHead& head) {
  if (options.outputFile.empty()) return head.outputFile;
  if (!head.outputFile.empty() && options.parse.warn)
    options.parse.warn(describe(head.places.last({"outfile"}).value_or(SourcePlace{sceneName(options)})) +
                       ": warning: outfile " + head.outputFile + " is ignored: -O " + options.outputFile);
  return options.outputFile;
}

}  // namespace

// differs from rayshade4: a file for each frame; there each overwrites the one before.
std::string frameFile(const std::string& name, std::int32_t frame, std::int32_t frames) {
  if (frames <= 1 || name.empty() || name == "-") return name;
  char number[16];
  std::snprintf(number, sizeof number, ".%04d", frame);
  const std::size_t slash = name.find_last_of('/');
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return name + number;
  return name.substr(0, dot) + number + name.substr(dot);
}

std::string placeOf(const std::string& file) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return std::string(host) + ":" + std::filesystem::absolute(file).lexically_normal().string();
}

FrameFiles::FrameFiles(const Options& options, const SceneHead& head, const std::string& reads)
    : options_(options), head_(head), name_(chooseOutput(options, head)) {
  // differs from rayshade4, which floods the terminal.
  if (!named() && (isatty(STDOUT_FILENO) || !reads.empty()))
    throw CommandLineError((reads.empty() ? "a terminal" : reads) +
                           " shows no pictures: say where to, -O FILE.png");
}

std::unique_ptr<PictureWriter> FrameFiles::open(std::int32_t frame) const {
  const PixelArea area = *pixelArea(head_.picture);
  const std::string file = nameOf(frame);
  std::optional<PictureFormat> format = formatOf(file);
  if (options_.sixteenBit && format == PictureFormat::png) format = PictureFormat::png16;
  return std::make_unique<PictureWriter>(file, area.width, area.height, head_.picture.gamma, format);
}

}  // namespace rayshade
