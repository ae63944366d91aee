// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/clients/messages/pose.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// The pose that a scan has shown.
[[nodiscard]] clients::PoseMessage message_of(const TrackPoint& point);

/// Poses between scans and after the last one: the motion filter's own prediction, with its covariance. Pure.
class PosePredictor {
 public:
  /// No pose is predicted farther from the last scan.
  static constexpr Duration kFarthest = std::chrono::milliseconds(500);

  void take(const PoseNews& news) { newest_ = news; }
  /// None: before the first pose, not after the last one, or too long after it.
  [[nodiscard]] std::optional<clients::PoseMessage> at(Time now) const;

 private:
  std::optional<PoseNews> newest_;
};

}  // namespace cairn::app
