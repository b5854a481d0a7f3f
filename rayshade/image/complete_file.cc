// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/complete_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "rayshade/image/picture_format.h"

namespace rayshade {

CompleteFile::CompleteFile(const std::string& fileName) : name_(fileName) {
  if (name_.empty() || name_ == "-") {
    name_ = "standard output";
    file_ = stdout;
    return;
  }
  std::error_code error;
  const auto status = std::filesystem::status(name_, error);
  if (std::filesystem::is_directory(status)) failOn(name_, "is a directory");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    open(name_, O_WRONLY);
    return;
  }
  final_ = name_;
  if (std::filesystem::exists(status)) {
    if (access(name_.c_str(), W_OK) != 0) failOn(name_, std::strerror(errno));
    final_ = std::filesystem::canonical(name_, error).string();  // a link stays a link
    if (error) failOn(name_, error.message());
  }
  const std::string beside = final_ + ".part-" + std::to_string(getpid());
  for (int attempt = 0; file_ == nullptr; ++attempt) {
    const std::string candidate = beside + "-" + std::to_string(attempt);
    const bool last = attempt == 99;
    if (open(candidate, O_WRONLY | O_CREAT | O_EXCL, !last)) temporary_ = candidate;
  }
}

CompleteFile::~CompleteFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void CompleteFile::write(const void* bytes, std::size_t size) {
  if (!put(bytes, size)) failOn(name_, std::strerror(errno));
}

void CompleteFile::commit() {
  bool good = std::fflush(file_) == 0;
  if (file_ != stdout) good = (std::fclose(std::exchange(file_, nullptr)) == 0) && good;
  if (!good) failOn(name_, std::strerror(errno));
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), final_.c_str()) != 0) failOn(name_, std::strerror(errno));
  temporary_.clear();
}

// False only when the file exists, must not, and `another` name can be tried.
bool CompleteFile::open(const std::string& path, int flags, bool another) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST && another) return false;
  if (descriptor < 0) failOn(name_, std::strerror(errno));
  file_ = fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    close(descriptor);
    failOn(name_, std::strerror(errno));
  }
  return true;
}

}  // namespace rayshade
