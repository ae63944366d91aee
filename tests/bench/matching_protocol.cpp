// SPDX-License-Identifier: Apache-2.0
// Our methods from the 125 starts of tools/protocol.sh, with what their acceptance says, for the real OctoMaps cut in
// halves and for two robots in closed-form scenes, without PCL or recordings. CPU times of this thread.
//   matching_protocol [PAIR|all] [METHOD|all] [STARTS] [SEED]     PAIR: fr_079 geb079 corridor lobby office carpark
//   forest
#include <Eigen/Cholesky>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "fusion/matching/book/methods.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/support/recorded_data.hpp"
#include "tools/protocol/methods/starts.hpp"
#include "tools/protocol/pairs/halves.hpp"

namespace cairn::matching {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

struct Figures {
  int starts = 0, successes = 0, accepted = 0, wrongly_accepted = 0, book_accepted = 0, book_wrongly = 0;
  double error_m = 0, error_deg = 0, worst_m = 0, seconds = 0, slowest = 0, iterations = 0, nees = 0, overlap = 0;
};

void account(Figures& f, const MatchResult& r, const SE3& truth) {
  const Vector6 error = (r.T_a_b.mean.inverse() * truth).log();
  const protocol::PoseError off = protocol::error_of(r.T_a_b.mean, truth);
  const bool success = off.success();
  ++f.starts;
  f.successes += success;
  (success ? f.accepted : f.wrongly_accepted) += r.accepted;
  (success ? f.book_accepted : f.book_wrongly) += r.book_accepted;
  f.iterations += r.iterations;
  f.overlap += r.overlap;
  if (!success) return;
  f.error_m += off.m;
  f.error_deg += off.deg;
  f.worst_m = std::max(f.worst_m, off.m);
  f.nees += error.dot(r.T_a_b.covariance.ldlt().solve(error));
}

void print(const support::MapPair& pair, std::string_view method, const Figures& f, double preparation) {
  const double n = f.starts, good = std::max(1, f.successes);
  std::printf(
      "%-10s %-10s overlap %.2f success %3d/%3d err %.4f m %.3f deg worst %.4f | accepted %d wrong %d (book %d wrong "
      "%d) NEES/6 "
      "%.2f | cpu %.4f s max %.4f prep %.3f it %.0f\n",
      pair.name.c_str(), std::string(method).c_str(), f.overlap / n, f.successes, f.starts, f.error_m / good,
      f.error_deg / good, f.worst_m, f.accepted, f.wrongly_accepted, f.book_accepted, f.book_wrongly, f.nees / good / 6,
      f.seconds / n, f.slowest, preparation, f.iterations / n);
  std::fflush(stdout);
}

void run(const support::MapPair& pair, std::string_view method, int count) {
  const Duration t0 = thread_cpu_time();
  const auto a = MapFeatures::build(*pair.a), b = MapFeatures::build(*pair.b);
  if (!a || !b) return (void)std::printf("%s: too large\n", pair.name.c_str());
  const auto matcher = make_any_matcher(method, *a, *b);
  const double preparation = to_seconds(thread_cpu_time() - t0);
  if (!matcher) return (void)std::printf("%s\n", to_string(matcher.error()).c_str());
  std::printf("%-10s %zu and %zu occupied voxels, %zu and %zu fine surfels\n", pair.name.c_str(),
              occupied_voxels(*pair.a)->size(), occupied_voxels(*pair.b)->size(), a->fine().size(), b->fine().size());
  Figures f;
  for (const int i : protocol::chosen_starts(count)) {
    const SE3 from = protocol::start_pose(pair.T_a_b, protocol::starts()[static_cast<std::size_t>(i)]);
    Budget budget = Budget::steps(kAmpleSteps);
    const Duration start = thread_cpu_time();
    const auto r = (*matcher)->match(UncertainPose{from, default_prior_covariance()}, budget);
    const double seconds = to_seconds(thread_cpu_time() - start);
    if (!r) return (void)std::printf("%s\n", to_string(r.error()).c_str());
    f.seconds += seconds;
    f.slowest = std::max(f.slowest, seconds);
    account(f, *r, pair.T_a_b);
    if (std::getenv("TRACE") != nullptr) {
      const Evidence& e = r->evidence;
      const Vector6 error = (r->T_a_b.mean.inverse() * pair.T_a_b).log();
      std::printf(
          "%d err %.3f %.3f (%.3f %.3f %.3f) | in %.2f n %d conf %.4f rev %.4f weak %.3f uniq %.2f ov %.2f q %.2f p "
          "%.3f %s\n",
          i, error.head<3>().norm(), error.tail<3>().norm() / kDegree_rad, error[0], error[1], error[2],
          e.structure_inliers, e.structure_pairs, e.conflict, e.reverse_conflict, e.weakest_translation, e.uniqueness,
          e.overlap, e.inlier_ratio, r->probability_correct, r->reason.c_str());
    }
  }
  print(pair, method, f, preparation);
}

std::vector<support::MapPair> pairs(const std::string& wanted, unsigned seed, double share) {
  std::vector<support::MapPair> out;
  for (const std::string name : {"fr_079", "geb079"}) {
    if (wanted != "all" && wanted != name) continue;
    const auto map = mapping::load_map(support::recorded_data("octomap") / (name + ".bt"));
    if (!map) {
      std::printf("%s\n", to_string(map.error()).c_str());
      continue;
    }
    const auto cut =
        protocol::halves(**map, name, {.overlap = share, .yaw = (79 + 51.0 * seed) * kDegree_rad, .seed = seed});
    out.push_back({name, cut.a, cut.b, cut.T_a_b});
  }
  for (const support::Scene& scene : support::all_scenes())
    if ((wanted == "all" && scene.name != "endless") || wanted == scene.name)
      out.push_back(
          support::two_robots(scene, {0, 3, 36}, {3 * (1 - share), 3 * (2 - share), 36}, seed, 1.3 + 0.7 * seed));
  return out;
}

}  // namespace
}  // namespace cairn::matching

int main(int argc, char** argv) {
  using namespace cairn::matching;
  const std::string wanted = argc > 1 ? argv[1] : "all", method = argc > 2 ? argv[2] : "default";
  const int starts = argc > 3 ? std::max(1, std::atoi(argv[3])) : cairn::protocol::kStarts;
  const auto seed = static_cast<unsigned>(argc > 4 ? std::atoi(argv[4]) : 1);
  const double share = argc > 5 ? std::atof(argv[5]) : 0.4;
  for (const auto& pair : pairs(wanted, seed, share))
    for (const std::string_view name : all_method_names())
      if (method == "all" || method == name) run(pair, name, starts);
}
