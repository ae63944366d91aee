// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hal/labels.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/answer_log.hpp"
#include "onboard/app/perception/waiting_list.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// Keeps boxes of pictures until the scans around them are known, and then tells them to those who follow people.
class BoxJoiner {
 public:
  static constexpr std::size_t kWaiting = 8;  ///< pictures of each camera; of more, the oldest is left out
  /// A picture whose time is so far ahead is not waited for.
  static constexpr Duration kAhead = std::chrono::milliseconds(500);

  /// Both must outlive the joiner.
  BoxJoiner(Robot& robot, Monitor& monitor) : robot_(robot), monitor_(monitor) {}

  /// Takes the boxes; what is left in `boxes` is memory to be used again.
  void add(people::Eye eye, Detections& boxes);
  /// Tells what has its scans by now. Call it after the scan of the tick is in the map.
  void join(Time now);

  /// Pictures without scans around them. Any thread may read.
  [[nodiscard]] const RelaxedCounter& apart() const { return apart_; }
  /// What the detectors said, where the profile asks for it.
  [[nodiscard]] const AnswerLog& answers() const { return answers_; }

 private:
  void join(people::Eye eye, Time now);
  void leave_out(const Detections& boxes, const std::string& why);

  Robot& robot_;
  Monitor& monitor_;
  std::array<WaitingList<Detections>, 2> waiting_;
  RelaxedCounter apart_;
  AnswerLog answers_;
};

}  // namespace cairn::app
