// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "hal/files/file_calls.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// Remembers across restarts when the program began, to see a crash loop: in a file of a few lines, one per start
/// ("boot stamp_ns"), of which the last ten are kept.
class StartLog {
 public:
  static constexpr int kMaxStarts = 3;  ///< within kWindow; after more, Fault::kCrashLoop: no drive, telemetry alone
  static constexpr Duration kWindow = std::chrono::minutes(1);

  explicit StartLog(std::filesystem::path file, FileCalls& calls = FileCalls::machine())
      : file_(std::move(file)), calls_(calls) {}

  /// Notes this start. True: it is one too many. A log that cannot be read or written counts as empty: a full disk must
  /// not keep the robot from starting.
  bool begin(Time now, std::string_view boot);
  /// The program ends because it was told to: nothing to hold against the next start.
  void end();

 private:
  std::filesystem::path file_;
  FileCalls& calls_;
};

}  // namespace cairn::app
