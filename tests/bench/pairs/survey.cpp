// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/pairs/survey.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::pairs {
namespace {

using simulator::Random;

// A Velodyne VLP-16 on a small robot that rocks, at a fifth of its directions.
constexpr double kSensorHeight_m = 0.73, kNoise_m = 0.02, kNearest_m = 0.5;
constexpr int kRings = 16, kDirections = 360;
constexpr std::size_t kScans = 2;  // at each stop
constexpr double kRocks_rad = 0.06, kBeside_m = 0.5;
constexpr double kPlaceNoise_m = 0.02, kTurnNoise_rad = 0.002;
constexpr std::uint64_t kNoiseStream = 61, kDropStream = 62;

SE3 disturbed(const Eigen::Vector3d& origin, Random& random) {
  const auto [x, y] = random.normal_pair();
  const auto [turn, up] = random.normal_pair();
  Vector6 v;
  v << origin.x() + kPlaceNoise_m * x, origin.y() + kPlaceNoise_m * y, origin.z() + 0.5 * kPlaceNoise_m * up, 0, 0,
      kTurnNoise_rad * turn;
  return SE3::from_xyz_rpy(v);
}

std::vector<Eigen::Vector3d> scan(const simulator::Tracer& tracer, const Eigen::Vector3d& origin, double range_m,
                                  Random& random) {
  Vector6 rocking;
  rocking << 0, 0, 0, random.uniform(-kRocks_rad, kRocks_rad), random.uniform(-kRocks_rad, kRocks_rad),
      random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Matrix3d turn = SE3::from_xyz_rpy(rocking).rotation();
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < kDirections; ++k)
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = 2 * std::numbers::pi * k / kDirections, up = (2.0 * ring - 15) * std::numbers::pi / 180;
      const Eigen::Vector3d ahead =
          turn * Eigen::Vector3d(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
      if (const auto hit = tracer.trace({origin, ahead}, kNearest_m, 1.5 * range_m))
        points.push_back((hit->distance + kNoise_m * random.normal_pair().first) * ahead);
    }
  return points;
}

void drop(mapping::SemanticOcTree& map, double share, Random& random) {
  std::vector<octomap::OcTreeKey> lost;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf) && leaf.getDepth() == map.getTreeDepth() && random.uniform() < share)
      lost.push_back(leaf.getKey());
  for (const octomap::OcTreeKey& key : lost) map.deleteNode(key);
  map.canonicalise();
}

}  // namespace

Ground::Ground(simulator::World w) : world(std::move(w)), tracer(*simulator::Tracer::build(world.mesh)) {}

std::unique_ptr<mapping::SemanticOcTree> survey(const Ground& ground, std::span<const Eigen::Vector2d> stops,
                                                const Survey& how) {
  mapping::MappingConfig config;
  config.resolution_m = how.voxel_m;
  config.max_range_m = how.range_m;
  Workers workers(1);
  mapping::Mapper mapper(config, workers);
  const Eigen::Vector3d mirror(1, how.mirrored ? -1 : 1, 1);
  for (std::size_t i = 0; i < kScans * stops.size(); ++i) {
    Random random(how.seed, kNoiseStream, i);
    const Eigen::Vector2d at = stops[i / kScans] + Eigen::Vector2d(random.uniform(-kBeside_m, kBeside_m),
                                                                   random.uniform(-kBeside_m, kBeside_m));
    const Eigen::Vector3d origin(at.x(), at.y(), ground.world.ground(at.x(), at.y()) + kSensorHeight_m);
    const SE3 believed = disturbed(origin, random);
    const auto placed = [&](const Eigen::Vector3d& p) -> Eigen::Vector3f {
      return (how.T_map_world * (believed * p).cwiseProduct(mirror)).cast<float>();
    };
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3d& p : scan(ground.tracer, origin, how.range_m, random)) points.push_back(placed(p));
    (void)mapper.insert(points, placed(Eigen::Vector3d::Zero()));
  }
  auto map = std::make_unique<mapping::SemanticOcTree>(mapper.tree());
  Random random(how.seed, kDropStream);
  drop(*map, how.dropped, random);
  return map;
}

}  // namespace cairn::pairs
