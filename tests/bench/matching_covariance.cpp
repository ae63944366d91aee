// SPDX-License-Identifier: Apache-2.0
// Is the covariance of a match what its errors are? Two robots map one site, whose maps are matched from near the
// truth; the normalised error squared (NEES) over 6 should be 1 on average.
//   matching_covariance [rooms|worlds] FIRST_SEED PAIRS [SCANS]
// Seeds below 5000 were used for tuning, figures are from 5000 on.
#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "fusion/matching/default_matcher.hpp"
#include "tests/bench/missions/building.hpp"
#include "tests/bench/missions/explorer.hpp"
#include "tools/simulator/scenes/make_world.hpp"

namespace cairn::missions {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kDrive_m = 75;        // of each robot, at most
constexpr double kLeastOverlap = 0.2;  // of a pair that counts (4.21)

simulator::World world_of(const std::string& kind, std::uint64_t seed) {
  if (kind == "rooms") return make_building(Copies::kNone, seed);
  const auto& names = simulator::scene_names();
  return *simulator::make_world(names[seed % names.size()]);
}

struct Sums {
  int pairs = 0;
  double nees = 0, m = 0, rad = 0, worst = 0;
  Vector6 squares = Vector6::Zero(), errors = Vector6::Zero();
};

void account(Sums& s, const std::string& name, const matching::Look& look, const SE3& truth) {
  const Vector6 e = (look.T_a_b.mean.inverse() * truth).log();
  const Matrix6& C = look.T_a_b.covariance;
  const double nees = e.dot(C.ldlt().solve(e)) / 6;
  const Vector6 sigma = C.diagonal().cwiseSqrt();
  std::printf(
      "%-9s overlap %.2f NEES/6 %6.2f | error %7.4f %7.4f %7.4f m %7.3f %7.3f %7.3f deg | sigma %.4f %.4f %.4f m "
      "%.3f %.3f %.3f deg\n",
      name.c_str(), look.evidence.overlap, nees, e[0], e[1], e[2], e[3] / kDegree_rad, e[4] / kDegree_rad,
      e[5] / kDegree_rad, sigma[0], sigma[1], sigma[2], sigma[3] / kDegree_rad, sigma[4] / kDegree_rad,
      sigma[5] / kDegree_rad);
  std::fflush(stdout);
  ++s.pairs;
  s.nees += nees;
  s.m += e.head<3>().norm();
  s.rad += e.tail<3>().norm();
  s.worst = std::max(s.worst, e.head<3>().norm());
  s.squares += e.cwiseQuotient(sigma).cwiseAbs2();
}

void run(const std::string& kind, std::uint64_t seed, int scans, Sums& sums) {
  const Site site(world_of(kind, seed));
  Explorer a(site, 10 * seed, kDrive_m), b(site, 10 * seed + 1, kDrive_m);
  a.advance(scans);
  b.advance(scans);
  const SE3 truth = a.T_map_world() * b.T_map_world().inverse();
  const matching::DefaultMatcher matcher(a.features(), b.features());
  Vector6 off;
  off << 0.1, -0.1, 0.05, 0, 0, 0.01;
  Budget budget = Budget::steps(matching::kAmpleSteps);
  const matching::Look look = matcher.look_again(truth * SE3::exp(off), budget);
  if (look.evidence.overlap >= kLeastOverlap) account(sums, site.world.name, look, truth);
}

}  // namespace
}  // namespace cairn::missions

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "rooms";
  const auto first = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 5000);
  const auto pairs = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 20);
  const int scans = argc > 4 ? std::atoi(argv[4]) : 35;
  cairn::missions::Sums s;
  for (std::uint64_t seed = first; seed < first + pairs; ++seed) cairn::missions::run(kind, seed, scans, s);
  const double n = std::max(1, s.pairs);
  const cairn::Vector6 rms = (s.squares / n).cwiseSqrt();
  std::printf(
      "%s: %d pairs, NEES/6 mean %.2f (95 %% band %.2f to %.2f), error mean %.4f m %.3f deg, worst %.4f m, rms of "
      "error over sigma %.2f %.2f %.2f %.2f %.2f %.2f\n",
      kind.c_str(), s.pairs, s.nees / n, 1 - 1.96 / std::sqrt(3 * n), 1 + 1.96 / std::sqrt(3 * n), s.m / n,
      s.rad / n * 180 / std::numbers::pi, s.worst, rms[0], rms[1], rms[2], rms[3], rms[4], rms[5]);
}
