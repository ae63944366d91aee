// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/pose_predictor.hpp"

namespace cairn::app {

clients::PoseMessage message_of(const TrackPoint& point) {
  clients::PoseMessage message;
  message.stamp = point.stamp;
  message.lost = point.lost;
  message.degenerate_directions = static_cast<std::uint8_t>(point.degenerate_directions);
  message.epoch = point.epoch;
  message.T_odom_base = point.T_odom_base;
  message.twist = point.twist;
  return message;
}

std::optional<clients::PoseMessage> PosePredictor::at(Time now) const {
  if (!newest_ || now <= newest_->point.stamp || now - newest_->point.stamp > kFarthest) return std::nullopt;
  odometry::MotionFilter filter = newest_->filter;
  filter.predict(to_seconds(now - newest_->point.stamp), newest_->noise);
  clients::PoseMessage message = message_of(newest_->point);
  message.stamp = now;
  message.predicted = true;
  message.T_odom_base = filter.pose();
  message.twist = filter.state().twist;
  return message;
}

}  // namespace cairn::app
