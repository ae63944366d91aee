// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/missions/explorer.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::missions {
namespace {

// A Velodyne VLP-16 on a small robot.
// Noise: standard deviation of a range.
constexpr double kSensorHeight_m = 0.73, kNoise_m = 0.02;
constexpr double kLost = 0.01;                                 // share of the ranges
constexpr int kRings = 16, kDirections = 900;                  // of a scan
constexpr double kNearest_m = 0.5, kFarthest_m = 60;           // range of the tracer
constexpr std::uint64_t kFrameStream = 21, kNoiseStream = 22;  // of the random numbers

simulator::Path stops_along(const simulator::Path& path, double every) {
  simulator::Path stops{path.front()};
  double since = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    since += (path[i] - path[i - 1]).norm();
    if (since < every) continue;
    stops.push_back(path[i]);
    since = 0;
  }
  return stops;
}

mapping::MappingConfig mapping(double resolution_m) {
  mapping::MappingConfig config;
  config.resolution_m = resolution_m;
  config.max_range_m = Explorer::kRange_m;
  return config;
}

SE3 lean(simulator::Random& random, double most_deg) {
  const double angle = random.uniform(0, most_deg) * std::numbers::pi / 180,
               turn = random.uniform(0, 2 * std::numbers::pi);
  const double height = most_deg < 90 ? 0 : random.uniform(-1, 1), level = std::sqrt(1 - height * height);
  const Eigen::Vector3d axis(level * std::cos(turn), level * std::sin(turn), height);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), Eigen::Vector3d::Zero()};
}

}  // namespace

Site::Site(simulator::World w) : world(std::move(w)), plan(world), tracer(*simulator::Tracer::build(world.mesh)) {}

Explorer::Explorer(const Site& site, std::uint64_t seed, double drive_m, double resolution_m, double lean_deg)
    : site_(site),
      seed_(seed),
      resolution_m_(resolution_m),
      workers_(1),
      mapper_(std::make_unique<mapping::Mapper>(mapping(resolution_m), workers_)) {
  const simulator::RoutePlanner planner(site.world, site.plan, seed);
  const auto paths = planner.plan(1, drive_m);
  if (paths) stops_ = stops_along(paths->front(), kStop_m);
  simulator::Random random(seed, kFrameStream);
  Vector6 frame;
  frame << random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-0.5, 0.5), 0, 0,
      random.uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector2d start = stops_.empty() ? Eigen::Vector2d::Zero() : stops_.front();
  const Eigen::Vector3d from(start.x(), start.y(), site.world.ground(start.x(), start.y()));
  T_map_world_ = SE3::from_xyz_rpy(frame) * lean(random, lean_deg) * SE3(Eigen::Quaterniond::Identity(), -from);
  features_ = std::make_unique<matching::MapFeatures>(*matching::MapFeatures::build(mapper_->tree()));
}

std::unique_ptr<mapping::SemanticOcTree> Explorer::next_map(const SE3& slip) {
  auto map = std::make_unique<mapping::SemanticOcTree>(mapper_->tree());
  mapper_ = std::make_unique<mapping::Mapper>(mapping(resolution_m_), workers_);
  features_ = std::make_unique<matching::MapFeatures>(*matching::MapFeatures::build(mapper_->tree()));
  T_map_world_ = slip * T_map_world_;
  return map;
}

void Explorer::advance(int scans) {
  for (int i = 0; i < scans && next_ < stops_.size(); ++i) scan_at(stops_[next_++]);
  features_->update(mapper_->take_changed_tiles());
}

void Explorer::scan_at(const Eigen::Vector2d& at) {
  const Eigen::Vector3d origin(at.x(), at.y(), site_.world.ground(at.x(), at.y()) + kSensorHeight_m);
  simulator::Random random(seed_, kNoiseStream, next_);
  const double first = random.uniform(0, 2 * std::numbers::pi);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < kDirections; ++k)
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = first + 2 * std::numbers::pi * k / kDirections,
                   up = (2.0 * ring - 15) * std::numbers::pi / 180;
      const Eigen::Vector3d ahead(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
      const auto hit = site_.tracer.trace({origin, ahead}, kNearest_m, kFarthest_m);
      if (!hit || random.uniform() < kLost) continue;
      const double range = hit->distance + kNoise_m * random.normal_pair().first;
      const Eigen::Vector3d point = T_map_world_ * (origin + range * ahead);
      points.push_back(point.cast<float>());
    }
  const Eigen::Vector3d sensor = T_map_world_ * origin;
  (void)mapper_->insert(points, sensor.cast<float>());
}

}  // namespace cairn::missions
