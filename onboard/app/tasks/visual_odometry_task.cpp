// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/visual_odometry_task.hpp"

#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

VisualOdometryTask::VisualOdometryTask(const RobotProfile& profile, camera::Camera camera, stereo::Rectifier rectifier,
                                       Robot& robot, Monitor& monitor, Progress progress)
    : deadline_(profile.schedule.visual_odometry.deadline()),
      map_period_(from_seconds(1 / profile.stereo.map_rate_hz)),
      max_steps_(visual_odometry::most_steps(profile.visual_odometry)),
      camera_(std::move(camera)),
      rectifier_(std::move(rectifier)),
      robot_(robot),
      monitor_(monitor),
      latency_(monitor.stage("packet_to_pose")),
      progress_(std::move(progress)) {}

void VisualOdometryTask::tick(Tick& tick) {
  while (const ArrivedPicture* picture = pictures.take(tick)) {
    look(picture->packet, tick);
    if (tick.regime() != Regime::kDrain) break;
  }
  pictures.give_back(tick);
  publish_status(tick);
}

/// A frozen camera would show a robot that stands still.
Result<void> VisualOdometryTask::read(const Packet& packet) {
  if (stuck_.step(packet.channel, packet.payload()))
    return Error{Errc::kMalformed, "the camera is stuck: the same picture again and again", {}, {}, {}};
  const auto picture = camera_.decode(packet);
  if (!picture) return picture.error();
  return rectifier_.rectify(**picture, pair_);
}

void VisualOdometryTask::look(const Packet& packet, Tick& tick) {
  Budget budget = tick.budget(steps_slot, packet.arrival + deadline_, max_steps_);
  const auto seen = read(packet);
  const auto located = seen ? robot_.locate(pair_, budget, located_) : Result<TrackPoint>(seen.error());
  tick.settle(steps_slot, budget);
  lost_ = !located || located->lost;
  if (!located) {
    ++figures_.refused;
    monitor_.event(packet.arrival, "odometry", to_string(located.error()));
  } else {
    ++figures_.frames;
    if (!located->lost) ++figures_.tracked;
    teller_.tell(*located, robot_);
    hand_on(located_, packet.arrival, tick);
    keep_keyframe(*located);
  }
  if (tick.takes_time()) latency_.record(tick.figure_now() - packet.arrival);
  if (progress_) progress_(packet.arrival, figures_.frames);
}

void VisualOdometryTask::keep_keyframe(const TrackPoint& located) {
  const visual_odometry::Keyframe* keyframe = to_save_ == nullptr ? nullptr : robot_.new_keyframe();
  ToSave::Keyframe* out = keyframe == nullptr ? nullptr : to_save_->back();
  if (out == nullptr) return;  // a later one will do
  out->keyframe = *keyframe;
  out->epoch = located.epoch;
  to_save_->push();
}

void VisualOdometryTask::hand_on(const LocatedScan& located, Time arrival, Tick& tick) {
  if (located.lost || located.stamp < next_view_) return;
  ArrivedView* out = views.back(tick);
  if (out == nullptr)
    return monitor_.event(located.stamp, "odometry",
                          "a picture did not get into the map: who measures its points is behind");
  next_view_ = located.stamp + map_period_;
  out->pair = pair_;
  out->scan = located;
  out->arrival = arrival;
  views.push(tick);
}

/// The safety task hears of changes only.
void VisualOdometryTask::publish_status(Tick& tick) {
  if (lost_ == published_lost_ || tick.regime() == Regime::kDrain) return;
  OdometryNews* out = status.back(tick);
  if (out == nullptr) return;  // with the next tick
  out->lost = published_lost_ = lost_;
  status.push(tick);
}

}  // namespace cairn::app
