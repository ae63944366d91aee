// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/waiting_list.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// Keeps the clouds of a depth camera until the scans around them are known, and then puts them into the map.
class CloudJoiner {
 public:
  static constexpr std::size_t kWaiting = 4;  ///< clouds; of more, the oldest is left out

  /// What became of the clouds. Any thread may read.
  struct Figures {
    RelaxedCounter clouds;  ///< that are in the map
    RelaxedCounter points;  ///< in them
    RelaxedCounter apart;   ///< clouds without scans around them, or that the map did not take
  };

  /// Both must outlive the joiner.
  CloudJoiner(Robot& robot, Monitor& monitor) : robot_(robot), monitor_(monitor) {}

  /// Takes the cloud; what is left in `cloud` is memory to be used again.
  void add(DepthCloud& cloud);
  /// Of a cloud that is in the map now: when it was seen, and where the robot was.
  using Joined = std::function<void(Time stamp, const SE3& T_odom_base)>;
  /// Puts into the map what has its scans by now. Call it after the scan of the tick is in the map.
  void join(const Joined& joined);

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void leave_out(const Error& why);

  Robot& robot_;
  Monitor& monitor_;
  WaitingList<DepthCloud> waiting_;
  Figures figures_;
};

}  // namespace cairn::app
