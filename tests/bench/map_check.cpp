// SPDX-License-Identifier: Apache-2.0
// How often is a sound map called inconsistent, and how large must a slip of the pose be to be found? A robot makes
// submaps one after the other; between the second and the third its pose slips, or not.
//   map_check FIRST_SEED ROUTES
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "fusion/matching/belief/map_check.hpp"
#include "fusion/matching/matcher.hpp"
#include "tests/bench/missions/building.hpp"
#include "tests/bench/missions/explorer.hpp"

namespace cairn::missions {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kSubmaps = 4, kScans = 8;

struct Slip {
  double metres, degrees;
};
constexpr std::array<Slip, 7> kSlips{{{0, 0}, {0.02, 0.1}, {0.1, 0}, {0.2, 0}, {0.4, 0}, {0, 1}, {0, 2}}};

struct Count {
  int pairs = 0, alarms = 0, maps = 0, flagged = 0;
};

/// A slip about where the robot stands, in a direction that the seed decides.
SE3 slip_at(const Slip& slip, const SE3& T_map_world, const Eigen::Vector2d& world, std::uint64_t seed) {
  const double way = 0.7 + 2.4 * static_cast<double>(seed % 7);
  Vector6 moved;
  moved << slip.metres * std::cos(way), slip.metres * std::sin(way), 0, 0, 0,
      (seed % 2 == 0 ? 1 : -1) * slip.degrees * kDegree;
  const SE3 here(Eigen::Quaterniond::Identity(), T_map_world * Eigen::Vector3d(world.x(), world.y(), 0));
  return here * SE3::from_xyz_rpy(moved) * here.inverse();
}

void run(const Site& site, std::uint64_t seed, const Slip& slip, Count& count) {
  Explorer robot(site, seed, 60);
  std::vector<std::unique_ptr<mapping::SemanticOcTree>> maps;
  for (int i = 0; i < kSubmaps; ++i) {
    robot.advance(kScans);
    const bool now = i + 1 == kSubmaps / 2;
    const SE3 wrong = now ? slip_at(slip, robot.T_map_world(), robot.at(), seed) : SE3();
    maps.push_back(robot.next_map(wrong));
  }
  std::vector<matching::MapFeatures> features;
  for (const auto& map : maps) features.push_back(*matching::MapFeatures::build(*map));
  std::vector<const matching::MapFeatures*> submaps;
  for (const auto& f : features) submaps.push_back(&f);
  Budget budget = Budget::steps(matching::kAmpleSteps);
  bool flagged = false;
  for (const auto& pair : matching::check_submaps(submaps, budget)) {
    if ((pair.first < kSubmaps / 2) == (pair.second < kSubmaps / 2) && slip.metres + slip.degrees > 0) continue;
    ++count.pairs;
    count.alarms += pair.consistent ? 0 : 1;
    flagged = flagged || !pair.consistent;
  }
  ++count.maps;
  count.flagged += flagged ? 1 : 0;
}

}  // namespace
}  // namespace cairn::missions

int main(int argc, char** argv) {
  using namespace cairn::missions;
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoi(argv[1]) : 7000);
  const auto routes = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 20);
  std::array<Count, kSlips.size()> counts;
  for (std::uint64_t seed = first; seed < first + routes; ++seed) {
    const Site site(make_building(Copies::kNone, seed));
    for (std::size_t k = 0; k < kSlips.size(); ++k) run(site, seed, kSlips[k], counts[k]);
  }
  for (std::size_t k = 0; k < kSlips.size(); ++k)
    std::printf("slip %.2f m %.1f deg: %d of %d pairs across it called inconsistent, %d of %d maps\n", kSlips[k].metres,
                kSlips[k].degrees, counts[k].alarms, counts[k].pairs, counts[k].flagged, counts[k].maps);
}
