// SPDX-License-Identifier: Apache-2.0
// Who moves around the robot: people and teammates, who stay out of its map.
#include <algorithm>
#include <iterator>

#include "onboard/perception/people/ground_below.hpp"
#include "onboard/robot.hpp"

namespace cairn {
namespace {

constexpr double kMateUnsure = 0.3;   // m: where a teammate is, is known so well
constexpr double kMateGround = 0.05;  // m above its base_link: the ground below it belongs to the map
// A picture's cloud may come so late. Then the one before will do, if it is near enough.
constexpr Duration kCloudWait = std::chrono::milliseconds(400), kCloudApart = std::chrono::milliseconds(250);

people::Space space_of(mapping::Standing standing) {
  switch (standing) {
    case mapping::Standing::kFree:
      return people::Space::kFree;
    case mapping::Standing::kOccupied:
      return people::Space::kNew;
    case mapping::Standing::kSettled:
      return people::Space::kSettled;
    case mapping::Standing::kUnknown:
      break;
  }
  return people::Space::kUnknown;
}

/// Where a track was at `t`, on a line from step to step, and with its velocity beyond the last one.
people::Step place_at(const people::Track& track, Time t) {
  const auto& steps = track.steps();
  const auto after = std::ranges::lower_bound(steps, t, {}, &people::Step::stamp);
  if (after == steps.begin()) return *after;
  people::Step place = *std::prev(after);
  const Eigen::Vector2d way =
      after == steps.end()
          ? track.person().velocity
          : Eigen::Vector2d((after->position - place.position) / to_seconds(after->stamp - place.stamp));
  place.position += to_seconds(t - place.stamp) * way;
  place.stamp = t;
  return place;
}

}  // namespace

void Robot::note_mates(std::span<const Mate> mates, std::uint32_t epoch) {
  mates_.clear();
  if (epoch == mapped_epoch_) mates_.assign(mates.begin(), mates.end());
}

void Robot::leave_mates_out(Time stamp) {
  for (const Mate& mate : mates_) {
    if (std::chrono::abs(stamp - mate.stamp) > kMateLife || mate.radius_m <= 0) continue;
    const Eigen::Vector2d middle = mate.position.head<2>() + to_seconds(stamp - mate.stamp) * mate.velocity;
    const double radius = mate.radius_m + kMateUnsure;
    std::erase_if(points_odom_, [&](const Eigen::Vector3f& p) {
      const double height = static_cast<double>(p.z()) - mate.position.z();
      return height > kMateGround && height < mate.height_m + kMateUnsure &&
             (p.head<2>().cast<double>() - middle).squaredNorm() < radius * radius;
    });
  }
}

/// What is left in points_odom_ is what stands.
void Robot::leave_people_out(Time stamp, const Eigen::Vector3f& origin_odom, float mount_height) {
  const StageTimer timing(monitor_.stage("people"));
  if (eyes_) height_ = people::height_above_ground(points_odom_, origin_odom).value_or(height_);
  people_->observe({stamp, points_odom_, origin_odom, eyes_ ? height_ : mount_height},
                   [this](const Eigen::Vector3f& point) { return space_of(mapper_.standing(point)); });
  const auto mask = people_->mask();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_odom_.size(); ++i)
    if (mask[i] == 0) points_odom_[kept++] = points_odom_[i];
  points_odom_.resize(kept);
}

/// Of points in which nobody is looked for: those whom others have shown.
void Robot::leave_known_people_out(Time stamp) {
  const auto leave_out = [&](const people::Person& person) {
    const Eigen::Vector2d position = person.position + to_seconds(stamp - person.stamp) * person.velocity;
    std::erase_if(points_odom_, [&](const Eigen::Vector3f& p) { return people_->in_body(p, position, person.ground); });
  };
  std::ranges::for_each(people_->people(), leave_out);
  if (people_by_depth_) std::ranges::for_each(people_->newcomers(), leave_out);
}

/// Somebody is known to be a person only after some steps; until then, what was measured put a ghost into the map.
void Robot::take_back_new_people() {
  for (const people::Track* track : people_->take_new()) {
    for (const people::Step& step : track->steps()) take_back(looked_at().nearest(step.stamp), step);
    if (!people_by_depth_) continue;
    for (std::size_t i = 0; i < recent_.size(); ++i)
      if (recent_[i].stamp >= track->steps().front().stamp) take_back(&recent_[i], place_at(*track, recent_[i].stamp));
  }
}

/// What a scan of the step's time put into the map at a body that was there.
void Robot::take_back(const labelling::PlacedScan* scan, const people::Step& body) {
  if (scan == nullptr || scan->stamp != body.stamp) return;
  const Eigen::Matrix3f R = scan->T_odom_base.rotation().cast<float>();
  const Eigen::Vector3f t = scan->T_odom_base.translation().cast<float>();
  points_odom_.clear();
  for (const Eigen::Vector3f& p : scan->points_base)
    if (const Eigen::Vector3f point = R * p + t; people_->in_body(point, body.position, body.ground))
      points_odom_.push_back(point);
  mapper_.take_back(points_odom_);
}

std::span<const people::Person> Robot::people() const {
  return people_ ? people_->people() : std::span<const people::Person>();
}

/// Of clouds before: this one left the people out already.
void Robot::keep_cloud(const DepthCloud& cloud, const SE3& T_odom_base) {
  take_back_new_people();
  (void)clouds_.add(cloud.stamp, T_odom_base, Vector6::Zero(), mapped_epoch_, cloud.points_base);
}

/// Null while a cloud after `t` may still come.
Result<const labelling::PlacedScan*> Robot::looked_at_around(Time t) const {
  if (!people_by_depth_) return recent_.nearest(t);
  const bool later = clouds_.size() > 0 && clouds_[clouds_.size() - 1].stamp >= t;
  if (!later && recent_[recent_.size() - 1].stamp < t + kCloudWait)
    return static_cast<const labelling::PlacedScan*>(nullptr);
  const labelling::PlacedScan* cloud = clouds_.nearest(t);
  if (cloud == nullptr || std::chrono::abs(cloud->stamp - t) > kCloudApart)
    return Error{Errc::kNotFound, "no depth pictures around the picture: its boxes are left out", {}, {}, {}};
  return cloud;
}

Result<bool> Robot::see_people(people::Eye eye, const Detections& boxes) {
  if (!people_ || !people_->has(eye))
    return Error{Errc::kUnsupported, "boxes came of a camera that is not set up", {}, {}, {}};
  const auto T_odom_base = T_odom_base_at(boxes.stamp);
  if (!T_odom_base) return T_odom_base.error();
  if (!*T_odom_base) return false;
  const auto looked = looked_at_around(boxes.stamp);
  if (!looked) return looked.error();
  if (*looked == nullptr) return false;
  people_->hear(eye, boxes, (*looked)->stamp, **T_odom_base);
  if (people_->offset(eye).moved())
    monitor_.event(boxes.stamp, "people",
                   eye == people::Eye::kThermal
                       ? "camera_moved: boxes of the thermal camera are beside the people: check its mount, intrinsics"
                       : "camera_moved: boxes of the colour camera are beside the people: check its mount, intrinsics");
  take_back_new_people();
  return true;
}

}  // namespace cairn
