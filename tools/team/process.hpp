// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace cairn::team {

struct Command {
  std::vector<std::string> words;  ///< the program's path first
  std::filesystem::path folder;    ///< where it works
  std::filesystem::path log;       ///< its stdout and stderr are appended to this
  int network = -1;                ///< network namespace that it is in; −1: this program's
  int orphaned = SIGKILL;          ///< the signal that it gets when this program dies
};

/// A program started by this one, in a process group of its own (so that a terminal's ^C is for this program to act
/// upon). It does not outlive its object, nor this program.
class Process {
 public:
  /// Errors: kIo (the system refuses another process). A program that cannot be executed ends with 127 and says so in
  /// its log.
  static Result<Process> start(const Command& command);
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() { kill(); }

  void signal(int number) const;
  /// Its exit code (128 + signal where a signal ended it); none while it runs.
  std::optional<int> ended();
  /// SIGKILL, and its end waited for.
  void kill();
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  explicit Process(pid_t id) : id_(id) {}

  pid_t id_ = 0;  // 0: it has ended
  std::optional<int> code_;
};

}  // namespace cairn::team
