// SPDX-License-Identifier: Apache-2.0
// One look at two maps without an initial guess, in random buildings: how often it is right, by how much the maps
// overlap. Between the two robots' visits a dozen boxes of each building were moved; a fifth of b's occupied voxels is
// missing, and its frame lies anywhere.
//   matching_global [METHOD] [FIRST_SEED] [BUILDINGS] [LEAN_DEG] [VOXEL_M]     global 6000 10 1 0.1
//   LEAN_DEG: of b's frame; 180: anyhow
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/methods.hpp"
#include "hal/clock.hpp"
#include "tests/bench/missions/building.hpp"
#include "tests/bench/missions/explorer.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::missions {
namespace {

using simulator::Random;

// What is measured, not tuned.
constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kDrive_m = 90;  // of each robot, at most
// Share of b's occupied voxels.
constexpr double kDropped = 0.2;
constexpr int kBoxes = 12;  // that each visit moves
// Stops of 1.5 m between looks.
constexpr int kScansPerLook = 12, kLooks = 4;
// Occupied, in each map of a look.
constexpr std::size_t kLeastVoxels = 30'000;
// Bounds of the table's rows, overlap (4.21).
constexpr std::array<double, 5> kShares{1.01, 0.45, 0.30, 0.15, 0.05};

struct Row {
  int looks = 0, right = 0, exact = 0, accepted = 0, wrongly = 0;
  double seconds = 0, slowest = 0;
  std::vector<double> off_m, off_z, off_deg;  // of those that are right
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The building with boxes of this visit's own, away from where robots drive.
Site visit(std::uint64_t seed, std::uint64_t stream) {
  simulator::World world = make_building(Copies::kNone, seed);
  Random random(seed, stream);
  for (int i = 0; i < kBoxes; ++i) {
    const Eigen::Vector2d place = world.places[random.below(world.places.size())];
    const double turn = random.uniform(0, 2 * std::numbers::pi), off = random.uniform(1.2, 1.8);
    world.mesh.box({place.x() + off * std::cos(turn), place.y() + off * std::sin(turn), 0, turn},
                   random.uniform(0.4, 1.2), random.uniform(0.3, 0.6), random.uniform(0.5, 1.8),
                   simulator::Material::kWood);
  }
  return Site(std::move(world));
}

/// The map with holes.
std::unique_ptr<mapping::SemanticOcTree> spoilt(const mapping::SemanticOcTree& map, Random& random) {
  auto holed = std::make_unique<mapping::SemanticOcTree>(map);
  std::vector<octomap::OcTreeKey> lost;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf) && leaf.getDepth() == map.getTreeDepth() && random.uniform() < kDropped)
      lost.push_back(leaf.getKey());
  for (const octomap::OcTreeKey& key : lost) holed->deleteNode(key);
  return holed;
}

std::size_t occupied(const mapping::SemanticOcTree& map) {
  std::size_t count = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) count += map.isNodeOccupied(*leaf) ? 1 : 0;
  return count;
}

void look(const Explorer& a, const Explorer& b, const std::string& method, Random& random, std::vector<Row>& rows) {
  const auto map_b = spoilt(b.features().map(), random);
  if (std::min(occupied(a.features().map()), occupied(*map_b)) < kLeastVoxels) return;
  const auto of_b = matching::MapFeatures::build(*map_b);
  const SE3 truth = a.T_map_world() * b.T_map_world().inverse();
  const double share =
      matching::Judge(a.features(), b.features()).look(truth, matching::anywhere().covariance).evidence.overlap;
  const auto row = static_cast<std::size_t>(
      std::ranges::find_if(kShares, [&](double least) { return share >= least; }) - kShares.begin());
  if (row == kShares.size()) return;
  Budget budget = Budget::steps(matching::kAmpleSteps);
  const Duration start = thread_cpu_time();
  const auto found = (*matching::make_matcher(method, a.features(), *of_b))->match(std::nullopt, budget);
  const double seconds = to_seconds(thread_cpu_time() - start);
  const SE3 error = found->T_a_b.mean.inverse() * truth;
  // Where b's robot is: the frames' origins may be 20 m away.
  const Eigen::Vector3d at = b.T_map_world() * Eigen::Vector3d(b.at().x(), b.at().y(), 0);
  const double off_m = (error * at - at).norm(), off_deg = rotation_angle(error) / kDegree_rad;
  Row& r = rows[row];
  ++r.looks;
  if (off_m <= 0.5 && off_deg <= 3) {
    ++r.right;
    r.off_m.push_back(off_m);
    r.off_z.push_back(std::abs((b.T_map_world().rotation().transpose() * (error * at - at)).z()));
    r.off_deg.push_back(off_deg);
  }
  r.exact += off_m <= 0.05 && off_deg <= 0.3 ? 1 : 0;
  r.accepted += found->accepted ? 1 : 0;
  r.wrongly += found->accepted && (off_m > 0.6 || off_deg > 6) ? 1 : 0;
  r.seconds += seconds;
  r.slowest = std::max(r.slowest, seconds);
}

void print(const std::vector<Row>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Row& r = rows[i];
    std::printf(
        "  overlap %.2f to %.2f: %3d looks, right %3d (median %.3f m, %.3f of it upwards, %.2f deg; %3d within 5 cm "
        "and 0.3 deg); accepted "
        "%3d, "
        "wrongly %d; %.2f s of CPU, at most %.2f\n",
        kShares[i], kShares[i - 1], r.looks, r.right, median(r.off_m), median(r.off_z), median(r.off_deg), r.exact,
        r.accepted, r.wrongly, r.seconds / std::max(1, r.looks), r.slowest);
  }
  std::fflush(stdout);
}

void run(const std::string& method, std::uint64_t first, int buildings, double lean_deg, double voxel_m) {
  std::vector<Row> rows(kShares.size());
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(buildings); ++seed) {
    const Site of_a = visit(seed, 31), of_b = visit(seed, 32);
    Random random(seed, 33);
    Explorer a(of_a, 2 * seed, kDrive_m, voxel_m, 0), b(of_b, 2 * seed + 1, kDrive_m, voxel_m, lean_deg);
    for (int i = 0; i < kLooks; ++i) {
      a.advance(kScansPerLook);
      b.advance(kScansPerLook);
      look(a, b, method, random, rows);
    }
    std::printf("%s, %d buildings from %llu, leaning up to %.0f deg\n", method.c_str(),
                static_cast<int>(seed - first) + 1, static_cast<unsigned long long>(first), lean_deg);
    print(rows);
  }
}

}  // namespace
}  // namespace cairn::missions

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
  cairn::missions::run(argc > 1 ? argv[1] : "global", static_cast<std::uint64_t>(number(2, 6000)),
                       static_cast<int>(number(3, 10)), number(4, 1), number(5, 0.1));
}
