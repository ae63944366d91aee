// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/scheduler/releases.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// What one task did in a live run: every tick that was not idle, in order.
struct TaskLog {
  std::string name;
  Releases releases;
  std::vector<TickRecord> ticks;  ///< rising index
  std::uint64_t end = 0;          ///< the first release that was not served any more

  friend bool operator==(const TaskLog& a, const TaskLog& b) {
    return a.name == b.name && a.releases.first == b.releases.first && a.releases.period == b.releases.period &&
           a.ticks == b.ticks && a.end == b.end;
  }
};

/// schedule.log, a text file. With it, the replay of a recording gives the same bits as the live run that made it.
///
///     cairn-schedule 1
///     task 0 safety 81236000000 1000000        name, first release [ns], period [ns]
///     task 1 receive 81236000000 10000000
///     1 0 0 75                                 task, release, releases passed before it, slots without trailing zeros
///     1 1 0 76 0 1
///     end 0 60000                              the first release that was not served any more
///     end 1 6000
///
/// An idle tick (all zero) has no line.
struct ScheduleLog {
  std::vector<TaskLog> tasks;

  [[nodiscard]] const TaskLog* find(std::string_view name) const;
};

/// Bounds for hostile files. An hour at 2 kHz with every tick busy has fewer lines.
inline constexpr std::size_t kMaxLogTasks = 64, kMaxLogTicks = 20'000'000, kMaxLogBytes = std::size_t{1} << 30U;
/// Releases of all tasks, idle ones included: some days of a robot. A replay goes through each.
inline constexpr std::uint64_t kMaxLogReleases = 500'000'000;

/// Reads the text. Errors: kMalformed (with the line), kTruncated (the end lines are missing: the run was killed),
/// kLimit.
[[nodiscard]] Result<ScheduleLog> parse_schedule_log(std::string_view text);
[[nodiscard]] Result<ScheduleLog> load_schedule_log(const std::filesystem::path& file);

/// Writes the file during the run. close() returns the errors of the disk.
class ScheduleLogWriter {
 public:
  explicit ScheduleLogWriter(const std::filesystem::path& file) : file_(file), out_(file, std::ios::binary) {}

  void task(std::size_t number, std::string_view name, const Releases& releases);
  void tick(std::size_t task, const TickRecord& record);
  void end(std::size_t task, std::uint64_t index);
  void flush() { out_.flush(); }
  /// A part of it could not be written: the log stays without its end.
  [[nodiscard]] bool failed() const { return out_.fail(); }
  [[nodiscard]] Result<void> close();

 private:
  std::filesystem::path file_;
  std::ofstream out_;
};

}  // namespace cairn::scheduler
