// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/preprocessor.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "rayshade/base/error.h"
#include "rayshade/base/interruption.h"
#include "rayshade/language/tokens.h"

namespace rayshade {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;
constexpr std::size_t kMostMessages = std::size_t{1} << 16;  // of messages, then cpp is stopped

[[noreturn]] void failWith(const std::string& name, const std::string& what, int error) {
  throw SceneError(name + ": error: " + what + ": " + std::strerror(error));
}

// read() that goes on after signals, except those that end us.
ssize_t readSome(int descriptor, char* to, std::size_t most) {
  for (;;) {
    const ssize_t got = ::read(descriptor, to, most);
    if (got >= 0 || errno != EINTR) return got;
    checkInterruption();
  }
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// A descriptor of a temporary copy of what is left to read, at its beginning.
int spooled(int from, const std::string& name) {
  const std::unique_ptr<std::FILE, CloseFile> copy(std::tmpfile());
  if (!copy) failWith(name, "no temporary copy can be made", errno);
  std::vector<char> block(kBlock);
  ssize_t got;
  while ((got = readSome(from, block.data(), block.size())) > 0)
    if (std::fwrite(block.data(), 1, static_cast<std::size_t>(got), copy.get()) !=
        static_cast<std::size_t>(got))
      failWith(name, "no temporary copy can be made", errno);
  if (got < 0) failWith(name, "cannot be read", errno);
  if (std::fflush(copy.get()) != 0) failWith(name, "no temporary copy can be made", errno);
  const int kept = ::fcntl(::fileno(copy.get()), F_DUPFD_CLOEXEC, 0);
  if (kept < 0) failWith(name, "no temporary copy can be made", errno);
  return kept;
}

bool seekable(int descriptor) { return ::lseek(descriptor, 0, SEEK_SET) == 0; }

// Opens a file, or standard input, so that it can be read from its beginning as often as wanted.
int openText(const std::string& fileName, const std::string& name) {
  if (!fileName.empty() && fileName != "-") {
    const int file = ::open(fileName.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) {
      const int error = errno;
      checkInterruption();  // nobody may be writing into a named pipe
      failWith(name, "cannot be read", error);
    }
    return file;
  }
  if (!seekable(STDIN_FILENO)) {
    const int copy = spooled(STDIN_FILENO, name);
    ::dup2(copy, STDIN_FILENO);
    ::close(copy);
    ::lseek(STDIN_FILENO, 0, SEEK_SET);
  }
  const int text = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
  if (text < 0) failWith(name, "cannot be read", errno);
  return text;
}

// Is what stands behind the `#` at `offset` other than a line marker?
bool directiveAt(int text, off_t offset) {
  std::array<char, 32> line{};
  if (::pread(text, line.data(), line.size() - 1, offset + 1) < 0) return false;
  const char* p = line.data();
  while (*p == ' ' || *p == '\t') ++p;
  return !(*p >= '0' && *p <= '9') && std::strncmp(p, "line", 4) != 0;
}

bool hasDirective(int text, const std::string& name) {
  std::vector<char> block(kBlock);
  char before = '\n';
  off_t offset = 0;
  while (true) {
    const ssize_t got = ::pread(text, block.data(), block.size(), offset);
    if (got < 0) failWith(name, "cannot be read", errno);
    if (got == 0) return false;
    const char* begin = block.data();
    const char* const end = begin + got;
    if (offset == 0 && std::string_view(begin, end).starts_with(kByteOrderMark))
      begin += kByteOrderMark.size();
    for (const char* p = begin; p < end; ++p) {
      p = static_cast<const char*>(std::memchr(p, '#', static_cast<std::size_t>(end - p)));
      if (p == nullptr) break;
      const bool first = (p == begin ? before : p[-1]) == '\n';
      if (first && directiveAt(text, offset + (p - block.data()))) return true;
    }
    before = end[-1];
    offset += got;
  }
}

struct Pipe {
  int reading = -1, writing = -1;
};
Pipe makePipe(const std::string& name) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) failWith(name, "no pipe to cpp", errno);
  return {ends[0], ends[1]};
}

// cpp's messages in its own language, English, whatever the user's is.
std::vector<std::string> environmentInEnglish() {
  std::vector<std::string> variables;
  for (char** v = environ; *v != nullptr; ++v)
    if (std::strncmp(*v, "LC_ALL=", 7) != 0) variables.emplace_back(*v);
  variables.emplace_back("LC_ALL=C");
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

SceneText::SceneText(const std::string& fileName, bool preprocess, const std::string& arguments)
    : name_(fileName.empty() || fileName == "-" ? "<stdin>" : fileName), text_(openText(fileName, name_)) {
  try {
    // cpp knows files by name; what has no name, or can be read only once, comes through its standard input.
    const bool named = name_ == fileName && seekable(text_);
    // "./" keeps cpp from taking a name for an option.
    const bool odd = named && (fileName[0] == '-' || fileName[0] == '@');
    const std::string input = !named ? "-" : odd ? "./" + fileName : fileName;
    if (!seekable(text_)) {
      const int copy = spooled(text_, name_);
      ::close(text_);
      text_ = copy;
      ::lseek(text_, 0, SEEK_SET);
    }
    if (preprocess && (!arguments.empty() || hasDirective(text_, name_))) startPreprocessor(input, arguments);
  } catch (...) {
    closeAll();
    throw;
  }
}

SceneText::~SceneText() {
  stop();
  closeAll();
}

void SceneText::closeAll() {
  if (text_ >= 0) ::close(text_);
  if (messages_ >= 0) ::close(messages_);
  text_ = messages_ = -1;
}

void SceneText::startPreprocessor(const std::string& input, const std::string& arguments) {
  std::vector<std::string> command = {"cpp", "-traditional-cpp", "-undef"};
  std::istringstream words(arguments);
  for (std::string word; words >> word;) command.push_back(word);
  command.push_back(input);

  const Pipe output = makePipe(name_);
  const Pipe messages = makePipe(name_);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, text_, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.writing, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages.writing, STDERR_FILENO);
  std::vector<std::string> environment = environmentInEnglish();
  const int error =
      ::posix_spawnp(&cpp_, "cpp", &actions, nullptr, pointers(command).data(), pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(output.writing);
  ::close(messages.writing);
  ::close(text_);
  text_ = output.reading;
  messages_ = messages.reading;
  if (error != 0) {
    cpp_ = -1;
    failWith(name_, "the preprocessor `cpp` cannot be run", error);
  }
}

std::size_t SceneText::read(char* to, std::size_t most) {
  checkInterruption();  // a scene may be large
  if (messages_ >= 0) return readPreprocessed(to, most);
  const ssize_t got = readSome(text_, to, most);
  if (got < 0) failWith(name_, "cannot be read", errno);
  return static_cast<std::size_t>(got);
}

std::size_t SceneText::readPreprocessed(char* to, std::size_t most) {
  while (!stopped_) {
    std::array<pollfd, 2> waiting{{{text_, POLLIN, 0}, {messages_, POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) {
      if (errno == EINTR) {
        checkInterruption();
        continue;
      }
      failWith(name_, "cpp cannot be waited for", errno);
    }
    if (waiting[1].revents & POLLIN) readMessages();
    if (waiting[0].revents & (POLLIN | POLLHUP | POLLERR)) {
      const ssize_t got = readSome(text_, to, most);
      if (got < 0) failWith(name_, "cannot be read through cpp", errno);
      return static_cast<std::size_t>(got);
    }
  }
  return 0;
}

void SceneText::readMessages() {
  std::array<char, 4096> block;
  const ssize_t got = readSome(messages_, block.data(), block.size());
  if (got > 0) said_.append(block.data(), static_cast<std::size_t>(got));
  if (said_.size() > kMostMessages) stop();
}

void SceneText::stop() {
  if (cpp_ < 0) return;
  ::kill(cpp_, SIGKILL);
  ::waitpid(cpp_, &status_, 0);
  cpp_ = -1;
  stopped_ = true;
}

SceneText::Verdict SceneText::verdict() {
  if (messages_ < 0) return {};
  std::array<char, 4096> block;
  for (ssize_t got; !stopped_ && (got = readSome(messages_, block.data(), block.size())) > 0;) {
    said_.append(block.data(), static_cast<std::size_t>(got));
    if (said_.size() > kMostMessages) stop();
  }
  if (cpp_ >= 0) {
    while (::waitpid(cpp_, &status_, 0) < 0 && errno == EINTR) {
    }
    cpp_ = -1;
  }
  Verdict verdict{stopped_ || !WIFEXITED(status_) || WEXITSTATUS(status_) != 0, preprocessorMessages(said_)};
  const bool saysWhy = std::any_of(verdict.messages.begin(), verdict.messages.end(),
                                   [](const PreprocessorMessage& m) { return !m.isWarning; });
  if (verdict.failed && !saysWhy) {
    const std::string text = "the preprocessor `cpp` has failed";
    verdict.messages.push_back({false, text, name_ + ": error: " + text});
  }
  return verdict;
}

}  // namespace rayshade
