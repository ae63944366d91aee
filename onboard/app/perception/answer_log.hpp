// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "onboard/perception/people/people.hpp"

namespace cairn::app {

/// What the detectors said of bodies during a run, for answers.csv: t,camera,x,y,z,verdict,score,distance_m in seconds
/// and metres of odom. `t` is the time of the scan, `camera` is visible or thermal, `verdict` is person or silence. A
/// row for each body in view and picture.
class AnswerLog {
 public:
  static constexpr std::size_t kMostRows = std::size_t{1} << 22U;  ///< then no more are kept

  void add(std::span<const people::Answered> answers);
  /// `shift`: what was added to the recording's time.
  [[nodiscard]] std::string to_csv(Duration shift) const;

 private:
  std::vector<people::Answered> rows_;
};

}  // namespace cairn::app
