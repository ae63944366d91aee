// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/people.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/perception/people/body.hpp"
#include "onboard/perception/people/seen_through.hpp"

namespace cairn::people {
namespace {

constexpr float kBeside = 0.4F;                  // m from where somebody is expected beside a wall
constexpr double kOnBoard = 2.5, kSteady = 0.3;  // m from the LiDAR, and of that place
constexpr double kKnownBefore = 0.5;             // nats a scan: a detector's boxes still outweigh it
constexpr int kFewestBeside = 5;                 // points

}  // namespace

People::People(const PeopleConfig& config) : config_(config), finder_(config.farthest_m), tracker_(config) {}

void People::set_eye(Eye eye, const cameras::CameraModel& camera, const SE3& T_base_camera) {
  const DetectorTrust& trust = eye == Eye::kThermal ? config_.thermal : config_.visible;
  lifters_[static_cast<std::size_t>(eye)].emplace(camera, T_base_camera, trust.farthest_m);
}

void People::clear() {
  tracker_.clear();
  scans_.clear();
  mask_.clear();
}

void People::observe(const PeopleScan& scan, const Settled& settled) {
  const auto& clusters = finder_.find(scan.points_odom, scan.sensor_odom, scan.sensor_height_m);
  tracker_.step(
      scan.stamp, clusters,
      [&](const Eigen::Vector2d& at, std::span<const Eigen::Vector2d> others) {
        return look_for(at, others, scan, settled);
      },
      [&](const Track& track) {
        return !carried(track, scan) &&
               seen_through(track.steps().front().position, track.person().ground, scan.points_odom, scan.sensor_odom);
      });
  remember(scan, tracker_.bodies());
  doubt_furniture(scan, settled);
  fill_mask(scan);
}

/// Somebody beside a wall or in a group has no cluster. The points that are new there are the body's.
std::optional<Eigen::Vector2d> People::look_for(const Eigen::Vector2d& position,
                                                std::span<const Eigen::Vector2d> others, const PeopleScan& scan,
                                                const Settled& settled) const {
  const Eigen::Vector2f expected = position.cast<float>();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < scan.points_odom.size(); ++i) {
    const Eigen::Vector3f& p = scan.points_odom[i];
    const float height = finder_.heights()[i];
    if (height < kShin || height > kHead || (p.head<2>() - expected).norm() > kBeside || settled(p)) continue;
    const Eigen::Vector2d at = p.head<2>().cast<double>();
    const double distance = (at - position).norm();
    if (std::ranges::any_of(others, [&](const Eigen::Vector2d& o) { return (at - o).norm() < distance; })) continue;
    sum += at;
    ++count;
  }
  if (count < kFewestBeside) return std::nullopt;
  return Eigen::Vector2d(sum / count);
}

/// What keeps its place beside the LiDAR while the robot drives is the robot, or rides on it.
bool People::carried(const Track& track, const PeopleScan& scan) const {
  const Step &first = track.steps().front(), &last = track.steps().back();
  const auto began = std::ranges::find(scans_, first.stamp, &Remembered::stamp);
  if (began == scans_.end()) return false;
  const Eigen::Vector2d offset = last.position - scan.sensor_odom.head<2>().cast<double>();
  return offset.norm() < kOnBoard && (offset - (first.position - began->sensor)).norm() < kSteady;
}

void People::remember(const PeopleScan& scan, std::span<const Cluster> bodies) {
  if (scans_.size() == kScans) {
    scans_.push_back(std::move(scans_.front()));  // its memory is used again
    scans_.pop_front();
  } else {
    scans_.emplace_back();
  }
  scans_.back().stamp = scan.stamp;
  scans_.back().sensor = scan.sensor_odom.head<2>().cast<double>();
  scans_.back().bodies.assign(bodies.begin(), bodies.end());
}

bool People::hear(Eye eye, const Detections& boxes, Time scan, const SE3& T_odom_base) {
  auto& lifter = lifters_[static_cast<std::size_t>(eye)];
  const auto remembered = std::ranges::find(scans_, scan, &Remembered::stamp);
  if (!lifter || remembered == scans_.end()) return false;
  compare(eye, boxes, *remembered, T_odom_base);
  const auto verdicts = lifter->judge(boxes, remembered->bodies, T_odom_base);
  verdicts_.assign(verdicts.begin(), verdicts.end());
  if (offset(eye).moved()) std::ranges::replace(verdicts_, Verdict::kSilence, Verdict::kNothing);
  tracker_.hear(scan, verdicts_, eye == Eye::kThermal ? config_.thermal : config_.visible);
  return true;
}

void People::compare(Eye eye, const Detections& boxes, const Remembered& scan, const SE3& T_odom_base) {
  known_.clear();
  for (const auto& [id, body] : tracker_.bodies_of_people(scan.stamp))
    if (body < scan.bodies.size()) known_.push_back({id, scan.bodies[body]});
  const auto e = static_cast<std::size_t>(eye);
  offsets_[e].add(boxes.stamp, lifters_[e]->offsets(boxes, known_, T_odom_base));
}

bool People::in_body(const Eigen::Vector3f& point, const Eigen::Vector2d& position, float ground) const {
  const float height = point.z() - ground;
  if (height < kAnkle || height > kHead) return false;
  return (point.head<2>() - position.cast<float>()).norm() < static_cast<float>(config_.mask_radius_m);
}

/// People are never in the map, so what the map has long known is no person.
void People::doubt_furniture(const PeopleScan& scan, const Settled& settled) {
  furniture_.clear();
  for (const Person& person : people()) {
    const Eigen::Vector2f middle = person.position.cast<float>();
    int known = 0, all = 0;
    for (std::size_t i = 0; i < scan.points_odom.size(); ++i) {
      const float height = finder_.heights()[i];
      if (height < kShin || height > kHead || (scan.points_odom[i].head<2>() - middle).norm() > kBeside) continue;
      ++all;
      if (settled(scan.points_odom[i])) ++known;
    }
    if (2 * known > all) furniture_.push_back(person.id);
  }
  for (const std::uint32_t id : furniture_) tracker_.weigh(id, -kKnownBefore);
}

void People::fill_mask(const PeopleScan& scan) {
  mask_.assign(scan.points_odom.size(), 0);
  for (const Person& person : people())
    for (std::size_t i = 0; i < mask_.size(); ++i)
      if (in_body(scan.points_odom[i], person.position, person.ground)) mask_[i] = 1;
}

}  // namespace cairn::people
