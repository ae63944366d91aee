// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "hal/monitor.hpp"
#include "onboard/app/rejoin/rejoin_job.hpp"
#include "onboard/mapping/tree/tree_copy.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// Joins what a robot mapped before it lost its way to its present map. A part of the mapping task: it works in slices,
/// between scans. Comparing is another task's work.
class RejoinPlan {
 public:
  static constexpr Duration kPeriod =
      std::chrono::milliseconds(500);  ///< from a result to the next comparison, at least

  /// Both must outlive the plan.
  RejoinPlan(Robot& robot, Monitor& monitor) : robot_(robot), monitor_(monitor) {}

  /// Goes on for about a millisecond, while no scan waits. A comparison that is due is returned; take() is then called
  /// with its result, or not at all if the run ends.
  [[nodiscard]] std::optional<RejoinJob> step(Time now);
  /// The present map got what the robot saw there, in odom of the epoch.
  void went_to(const SE3& T_odom_base, std::uint32_t epoch);
  void take(RejoinJob result, Time now);
  /// The run ends: what a result allows to be joined is joined now.
  void finish(Time now);

 private:
  [[nodiscard]] const EarlierMap* next_map() const;
  void join(std::size_t tiles, Time now);
  bool begin(std::uint32_t epoch);  // true if it is another one

  Robot& robot_;
  Monitor& monitor_;
  std::uint32_t epoch_ = 0;  // of the present map; what follows is about it
  bool out_ = false;         // a job is
  Time due_ = Time::min();
  std::optional<mapping::TreeCopy> copy_;          // for the next job
  SE3 last_;                                       // where the robot was
  double way_m_ = 0;                               // that it has gone since the epoch began, turns included
  std::map<std::uint32_t, double> compared_at_m_;  // of that way, by the earlier epoch
  std::optional<RejoinJob> joining_;
  std::size_t joined_tiles_ = 0;  // of it
};

}  // namespace cairn::app
