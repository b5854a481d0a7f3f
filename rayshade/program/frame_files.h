// The files that the frames of a picture go to.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "rayshade/program/options.h"

namespace rayshade {

// Where frame number `frame` goes: name.png, or name.0007.png when there are several.
std::string frameFile(const std::string& name, std::int32_t frame, std::int32_t frames);

// Where a file is, for people who work on several machines: HOST:/absolute/path.
std::string placeOf(const std::string& file);

class FrameFiles {
 public:
  // -O, else what the scene says; warns when both do.  Throws CommandLineError when the bytes of a picture would go to a
  // terminal, or to somebody else who `reads` standard output as text: "the pvm console".
  FrameFiles(const Options& options, const SceneHead& head, const std::string& reads = "");

  std::string nameOf(std::int32_t frame) const { return frameFile(name_, frame, head_.picture.frames); }
  bool named() const { return !name_.empty() && name_ != "-"; }  // else standard output
  std::unique_ptr<PictureWriter> open(std::int32_t frame) const;

 private:
  const Options& options_;
  const SceneHead& head_;
  std::string name_;
};

}  // namespace rayshade
