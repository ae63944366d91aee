// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/people.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/perception/people/body.hpp"

namespace cairn::people {
namespace {

constexpr double kAlong = 0.7;                     // cosine of the angle between two ways that are alike
constexpr float kBeside = 0.4F;                    // m from where somebody is expected beside a wall
constexpr double kOnBoard = 2.5, kSteady = 0.3;    // m from the LiDAR, and of that place
constexpr double kKnownBefore = 0.5;               // nats a scan: a detector's boxes still outweigh it
constexpr int kFewestBeside = 5;                   // points
constexpr float kShoulder = 1.5F, kStepUp = 0.1F;  // m
constexpr int kFewestFree = 6;                     // voxels of 117
constexpr float kWhole = 0.7F;                     // m; a body of which the map knows a part already
constexpr float kSame = 0.6F;                      // m between two clusters of one body
constexpr double kHalf = 0.12;                     // m from the side that is seen to the middle

/// What comes into view beside a robot slides the way that the robot drives, and no farther. `driven`: the robot's way
/// since the track began.
bool slides(const Track& track, const Eigen::Vector2d& driven) {
  const Eigen::Vector2d way = track.steps().back().position - track.steps().front().position;
  return way.norm() < driven.norm() && way.dot(driven) > kAlong * way.norm() * driven.norm();
}

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

void People::observe(const PeopleScan& scan, const Known& known) {
  finder_.measure(scan.points_odom, scan.sensor_odom, scan.sensor_height_m);
  rays_.fill(scan.points_odom, scan.sensor_odom);
  ask_map(scan, known);
  find_bodies(scan, tracker_.predict(scan.stamp));
  tracker_.step(
      scan.stamp, clusters_,
      [&](const Eigen::Vector2d& at, std::span<const Eigen::Vector2d> others) { return look_for(at, others, scan); },
      [&](const Track& track) {
        if (carried(track, scan)) return false;
        const Step& first = track.steps().front();
        const auto began = std::ranges::find(scans_, first.stamp, &Remembered::stamp);
        if (track.newcomer() && track.upright() && began != scans_.end() &&
            !slides(track, scan.sensor_odom.head<2>().cast<double>() - began->sensor))
          return true;
        return is_free(first.position, first.ground, known) && rays_.seen_through(first.position, first.ground);
      },
      [&](const Track& track) { return rays_.seen_through(track.person().position, track.person().ground); });
  remember(scan, tracker_.bodies());
  doubt_furniture(scan);
  fill_mask(scan);
}

/// Whether the map has nothing where a body would stand.
bool People::is_free(const Eigen::Vector2d& position, float ground, const Known& known) {
  int free = 0;
  for (float height = kShin; height < kShoulder; height += kStepUp) {
    for (const float x : {-kStepUp, 0.0F, kStepUp}) {
      for (const float y : {-kStepUp, 0.0F, kStepUp}) {
        const Space space =
            known({static_cast<float>(position.x()) + x, static_cast<float>(position.y()) + y, ground + height});
        if (space == Space::kSettled) return false;
        if (space == Space::kFree) ++free;
      }
    }
  }
  return free >= kFewestFree;
}

void People::ask_map(const PeopleScan& scan, const Known& known) {
  spaces_.assign(scan.points_odom.size(), Space::kUnknown);
  for (std::size_t i = 0; i < spaces_.size(); ++i)
    if (finder_.at_body_height(i))
      spaces_[i] = finder_.on_wall(scan.points_odom[i], i) ? Space::kSettled : known(scan.points_odom[i]);
}

/// Without what has long stood there, people beside walls stand alone. With it, those are found who have long stood. Of
/// who walks behind a desk, the legs may be all that is seen.
void People::find_bodies(const PeopleScan& scan, std::span<const Eigen::Vector2d> seeds) {
  clusters_ = finder_.find(scan.points_odom, {.spaces = spaces_, .loose = true, .seeds = seeds});
  std::erase_if(clusters_, [&](const Cluster& cluster) {
    return cluster.low && !rays_.chest_is_hidden(cluster.centre.cast<double>(), cluster.ground);
  });
  const std::size_t loose = clusters_.size();
  for (const Cluster& cluster : finder_.find(scan.points_odom, {.spaces = spaces_, .loose = false, .seeds = {}})) {
    const auto same = [&](const Cluster& c) { return (c.centre - cluster.centre).norm() < kSame; };
    const auto parts = std::span(clusters_).first(loose);
    const auto count = std::ranges::count_if(parts, same);
    if (count == 0) clusters_.push_back(cluster);
    if (count == 1 && cluster.extent < kWhole) *std::ranges::find_if(parts, same) = cluster;
  }
  for (Cluster& cluster : clusters_) cluster.passed = rays_.passed(cluster.centre.cast<double>(), cluster.ground);
}

/// Somebody beside a wall or in a group has no cluster. The points that are new there are the body's.
std::optional<Tracker::Beside> People::look_for(const Eigen::Vector2d& position,
                                                std::span<const Eigen::Vector2d> others, const PeopleScan& scan) {
  const Eigen::Vector2f expected = position.cast<float>();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < scan.points_odom.size(); ++i) {
    const Eigen::Vector3f& p = scan.points_odom[i];
    if (finder_.loose()[i] == 0 || (p.head<2>() - expected).norm() > kBeside) continue;
    const Eigen::Vector2d at = p.head<2>().cast<double>();
    const double distance = (at - position).norm();
    if (std::ranges::any_of(others, [&](const Eigen::Vector2d& o) { return (at - o).norm() < distance; })) continue;
    sum += at;
    ++count;
  }
  if (count < kFewestBeside) return std::nullopt;
  const Eigen::Vector2d middle = sum / count;
  const float ground = finder_.ground_at(middle.cast<float>());
  return Tracker::Beside{.position = middle, .ground = ground, .passed = rays_.passed(middle, ground)};
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
  scans_.back().loose.clear();
  for (std::size_t i = 0; i < spaces_.size(); ++i)
    if (finder_.loose()[i] != 0) scans_.back().loose.push_back(scan.points_odom[i]);
}

bool People::hear(Eye eye, const Detections& boxes, Time scan, const SE3& T_odom_base) {
  answered_.clear();
  auto& lifter = lifters_[static_cast<std::size_t>(eye)];
  const auto remembered = std::ranges::find(scans_, scan, &Remembered::stamp);
  if (!lifter || remembered == scans_.end()) return false;
  compare(eye, boxes, *remembered, T_odom_base);
  const auto answers = lifter->judge(boxes, remembered->bodies, T_odom_base);
  answers_.assign(answers.begin(), answers.end());
  const bool moved = offset(eye).moved();
  if (moved)
    std::ranges::replace_if(
        answers_, [](const Answer& a) { return a.verdict == Verdict::kSilence; }, Answer{});
  const DetectorTrust& trust = eye == Eye::kThermal ? config_.thermal : config_.visible;
  tracker_.hear(scan, answers_, trust);
  if (config_.log_answers) note_answers(eye, *remembered);
  if (moved) return true;  // its boxes point beside the people
  auto lifted = lifter->lift(remembered->loose);
  for (Lifted& found : lifted) {
    found.position += kHalf * (found.position - remembered->sensor).normalized();
    found.ground = finder_.ground_at(found.position.cast<float>());
  }
  tracker_.hear_apart(scan, scans_.back().stamp, lifted, trust);
  return true;
}

void People::note_answers(Eye eye, const Remembered& scan) {
  for (std::size_t i = 0; i < answers_.size(); ++i)
    if (answers_[i].verdict != Verdict::kNothing)
      answered_.push_back({scan.stamp, eye, scan.bodies[i].centre, scan.bodies[i].ground, answers_[i]});
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
void People::doubt_furniture(const PeopleScan& scan) {
  furniture_.clear();
  for (const Person& person : people()) {
    const Eigen::Vector2f middle = person.position.cast<float>();
    int known = 0, all = 0;
    for (std::size_t i = 0; i < scan.points_odom.size(); ++i) {
      const float height = finder_.heights()[i];
      if (height < kShin || height > kHead || (scan.points_odom[i].head<2>() - middle).norm() > kBeside) continue;
      ++all;
      if (spaces_[i] == Space::kSettled) ++known;
    }
    if (2 * known > all) furniture_.push_back(person.id);
  }
  for (const std::uint32_t id : furniture_) tracker_.weigh(id, -kKnownBefore);
}

void People::fill_mask(const PeopleScan& scan) {
  mask_.assign(scan.points_odom.size(), 0);
  for (const auto& them : {people(), tracker_.newcomers()})
    for (const Person& person : them)
      for (std::size_t i = 0; i < mask_.size(); ++i)
        if (in_body(scan.points_odom[i], person.position, person.ground) && !finder_.on_wall(scan.points_odom[i], i))
          mask_[i] = 1;
}

}  // namespace cairn::people
