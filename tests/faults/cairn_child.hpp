// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/files/file.hpp"
#include "tests/support/places.hpp"

namespace cairn::faults {

/// The real program `cairn`, or another of this build, as a child. What it says goes into a file. It is killed with the
/// object.
class CairnChild {
 public:
  CairnChild(std::vector<std::string> arguments, std::filesystem::path says, std::string_view program = "cairn")
      : says_(std::move(says)), pid_(start(std::move(arguments), program, says_)) {}
  CairnChild(const CairnChild&) = delete;
  CairnChild& operator=(const CairnChild&) = delete;
  ~CairnChild() {
    signal(SIGKILL);
    (void)wait();
  }

  void signal(int number) const {
    if (pid_ > 0) ::kill(pid_, number);
  }
  /// Whether it has ended by now.
  [[nodiscard]] bool ended() {
    if (pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
    return pid_ < 0;
  }
  /// Waits for its end. Its exit code, or minus the number of the signal that killed it.
  int wait() {
    if (pid_ > 0) ::waitpid(pid_, &status_, 0);
    pid_ = -1;
    return WIFSIGNALED(status_) ? -WTERMSIG(status_) : WEXITSTATUS(status_);
  }
  [[nodiscard]] std::string said() const {
    const auto bytes = read_file(says_, 1 << 20);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
  }

 private:
  static ::pid_t start(std::vector<std::string> arguments, std::string_view program,
                       const std::filesystem::path& says) {
    arguments.insert(arguments.begin(), places::program(program));
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    const ::pid_t pid = ::fork();
    if (pid != 0) return pid;
    const int said = ::open(says.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(said, STDOUT_FILENO);
    ::dup2(said, STDERR_FILENO);
    ::execv(words[0], words.data());
    ::_exit(127);
  }

  std::filesystem::path says_;
  ::pid_t pid_;
  int status_ = 0;
};

}  // namespace cairn::faults
