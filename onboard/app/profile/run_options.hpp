// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// Where time comes from and how packets are waited for.
enum class Pace {
  kLive,      ///< devices, on the machine's clock
  kRecorded,  ///< a recording, as slowly as it was made
  kMaximum,   ///< a recording, as fast as the machine can
};

/// Who says what pictures show.
enum class NetworkUse {
  kOff,       ///< nobody: the map gets no labels
  kRun,       ///< the networks of the profile
  kRecorded,  ///< the recording: its labels/
};

/// What the command line says of one run.
struct RunOptions {
  std::filesystem::path config;     ///< empty: the recording's own, or the defaults
  std::filesystem::path recording;  ///< empty: live hardware
  std::filesystem::path out;
  std::filesystem::path record;     ///< live: where to keep the packets and the schedule; empty: nowhere
  std::filesystem::path schedule;   ///< of another live run, instead of the recording's own schedule.log
  std::filesystem::path state;      ///< live: where the map is kept for a restart; empty: nowhere
  bool peers = false;               ///< takes part in the team; a recording is then played as if by devices
  std::filesystem::path sockets;    ///< live: folder for the sockets of other programs; empty: none
  std::filesystem::path live_view;  ///< live: the local socket for `cairn top`; empty: none
  Pace pace = Pace::kRecorded;
  NetworkUse networks = NetworkUse::kRun;
  bool reference = false;  ///< at real speed: run an empty task beside the control task, to know what the machine costs
  std::optional<int> threads;     ///< instead of the profile's
  std::optional<double> seconds;  ///< ends the run when so much of the robot's time has passed
  /// Asked whether the run is to end: live about every 20 ms, in a replay before every tick. Any thread; empty: never.
  std::function<bool()> stop;
  std::function<void(Time, std::size_t scans)> progress;  ///< after every scan, on odometry's thread; may be empty

  /// True for live runs, and for recordings played among peers. They cannot be repeated by themselves; their recordings
  /// can.
  [[nodiscard]] bool live() const { return recording.empty() || peers; }
};

/// Nothing, or all options that this kind of run would ignore, each with the remedy (kInvalidConfig).
[[nodiscard]] Result<void> check(const RunOptions& options);

}  // namespace cairn::app
