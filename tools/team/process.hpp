// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace cairn::team_run {

struct Command {
  std::vector<std::string> words;  ///< the program's path first
  std::filesystem::path folder;    ///< its working directory
  std::filesystem::path log;       ///< its stdout and stderr are appended to this file
  int network = -1;                ///< its network namespace; −1: this program's
  int orphaned = SIGKILL;          ///< the signal that it gets when this program dies
};

/// A program that this program has started. It has a process group of its own: a terminal's ^C reaches only this
/// program. It ends with its object, and with this program.
class Process {
 public:
  /// Errors: kIo (the system refuses another process). A program that cannot be executed ends with 127, and its log
  /// says so.
  static Result<Process> start(const Command& command);
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() { kill(); }

  void signal(int number) const;
  /// Its exit code, or 128 + signal if a signal ended it; nothing while it runs.
  std::optional<int> ended();
  /// Sends SIGKILL, and waits for its end.
  void kill();
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  explicit Process(pid_t id) : id_(id) {}

  pid_t id_ = 0;  // 0: it has ended
  std::optional<int> code_;
};

}  // namespace cairn::team_run
