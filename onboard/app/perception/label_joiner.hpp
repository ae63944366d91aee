// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/labels.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/waiting_list.hpp"
#include "onboard/robot.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

inline constexpr const char* kPictureToMap = "picture_to_map";  ///< stage: from the exposure to the last voxel

/// Keeps label pictures until the scans around them are known, and then writes them into the map. A network is slower
/// than a scan, so most need not wait.
class LabelJoiner {
 public:
  static constexpr std::size_t kWaiting = 4;  ///< pictures; of more, the oldest is left out
  /// A picture whose time is so far ahead is not waited for.
  static constexpr Duration kAhead = std::chrono::milliseconds(500);

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter images;  ///< that reached the map
    RelaxedCounter points;  ///< that got a label
    RelaxedCounter voxels;  ///< that took evidence, counted once for each picture
    RelaxedCounter apart;   ///< pictures without scans around them
  };

  /// Both must outlive the joiner.
  LabelJoiner(Robot& robot, Monitor& monitor);

  /// Takes the labels; what is left in `labels` is memory to be used again.
  void add(LabelImage& labels);
  /// Writes into the map what has its scans by now. Call it after the scan of the tick is in the map.
  void join(const scheduler::Tick& tick);

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void leave_out(const LabelImage& labels, const std::string& why);
  void count(const mapping::LabelReport& report, const LabelImage& labels, const scheduler::Tick& tick);

  Robot& robot_;
  Monitor& monitor_;
  WaitingList<LabelImage> waiting_;
  Figures figures_;
};

}  // namespace cairn::app
