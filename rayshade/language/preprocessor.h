// The text of a scene, through the C preprocessor where it needs one.
//
// Debian's `cpp -traditional-cpp` is run only when a line of the text begins with a directive, or when the
// user gave it arguments; else the text is read as it is.  cpp is started without a shell; its messages and
// its exit status count (rayshade4 ignores both and renders what it got).  It is stopped when nobody wants to
// read on, and when its messages flood us, as those of files that include themselves do.
//
// Standard input is read twice, as a file is: when it is a pipe, a temporary copy without a name takes its
// place.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "rayshade/language/preprocessor_messages.h"

namespace rayshade {

class SceneText {
 public:
  // An empty name or "-" is standard input.  `arguments` are separated by blanks.  Throws SceneError.
  SceneText(const std::string& fileName, bool preprocess, const std::string& arguments);
  ~SceneText();
  SceneText(const SceneText&) = delete;
  SceneText& operator=(const SceneText&) = delete;

  const std::string& name() const { return name_; }  // for messages
  std::size_t read(char* to, std::size_t most);      // 0 at the end.  Throws SceneError

  // What cpp had to say; ask when the text has been read to its end.
  struct Verdict {
    bool failed = false;
    std::vector<PreprocessorMessage> messages;
  };
  Verdict verdict();

 private:
  void startPreprocessor(const std::string& input, const std::string& arguments);
  std::size_t readPreprocessed(char* to, std::size_t most);
  void readMessages();
  void stop();  // ends cpp, if it runs
  void closeAll();

  std::string name_;
  int text_ = -1;      // descriptor of the text or of cpp's output
  int messages_ = -1;  // of cpp's messages
  pid_t cpp_ = -1;     // runs
  bool stopped_ = false;
  int status_ = 0;  // of cpp, when it has ended
  std::string said_;
};

}  // namespace rayshade
