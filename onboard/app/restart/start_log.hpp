// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "hal/files/file_calls.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// Remembers when the program started, to find a crash loop: a file with one line per start ("boot stamp_ns"). The last
/// ten are kept.
class StartLog {
 public:
  static constexpr int kMaxStarts = 3;  ///< within kWindow; with more of them, Fault::kCrashLoop: the drive stays off
  static constexpr Duration kWindow = std::chrono::minutes(1);

  explicit StartLog(std::filesystem::path file, FileCalls& calls = FileCalls::machine())
      : file_(std::move(file)), calls_(calls) {}

  /// Notes this start. True: it is one too many. A log that cannot be read or written counts as empty, because a full
  /// disk must not keep the robot from starting.
  bool begin(Time now, std::string_view boot);
  /// The program ends as it was told to. This start counts no more.
  void end();

 private:
  std::filesystem::path file_;
  FileCalls& calls_;
};

}  // namespace cairn::app
