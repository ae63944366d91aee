// SPDX-License-Identifier: Apache-2.0
// Evidence of right and wrong matches, one line each, for fitting and checking the probability that a match is correct.
//   matching_evidence FIRST_SEED SEEDS     CSV on stdout
// Each seed gives pairs of maps of robots that rode random stretches of the closed-form scenes, and halves of the real
// OctoMaps where they are there. Each pair is matched from starts near the truth and far from it, and with maps of
// other scenes, where every answer is wrong.
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

#include "fusion/matching/methods.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/support/recorded_data.hpp"
#include "tools/protocol/pairs/halves.hpp"

namespace cairn::matching {
namespace {

// Error of a right match, at most: the book's protocol (section 4.6.3).
constexpr double kSuccess_m = 0.6, kSuccess_rad = 6 * std::numbers::pi / 180;

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

std::vector<support::MapPair> pairs(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<support::MapPair> out;
  for (const support::Scene& scene : support::all_scenes()) {
    const double a = uniform(random, 0, 6.28), length = uniform(random, 0.8, 3), apart = uniform(random, 0.1, 1.3);
    const double b = a + apart * length;
    out.push_back(support::two_robots(scene, {a, a + length, 24}, {b, b + length, 24}, 10 * seed,
                                      uniform(random, -3, 3), 0.1, uniform(random, 6, 15)));
  }
  for (const std::string name : {"fr_079", "geb079"})
    if (const auto map = mapping::load_map(support::recorded_data("octomap") / (name + ".bt"))) {
      const auto cut = protocol::halves(
          **map, name, {.overlap = uniform(random, 0.2, 0.6), .yaw = uniform(random, -3, 3), .seed = seed});
      out.push_back({.name = name, .a = cut.a, .b = cut.b, .T_a_b = cut.T_a_b});
    }
  return out;
}

SE3 start(const SE3& truth, double reach, std::mt19937& random) {
  const double turn = uniform(random, -1, 1) * (reach > 2 ? std::numbers::pi : 0.26);
  const Eigen::Vector3d shift(uniform(random, -reach, reach), uniform(random, -reach, reach), 0);
  return {truth.quaternion() * Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())),
          truth.translation() + shift};
}

void print(const std::string& name, const Matcher& matcher, const SE3& initial, const SE3* truth) {
  Budget budget = Budget::steps(kAmpleSteps);
  const auto r = matcher.match(UncertainPose{initial, default_prior_covariance()}, budget);
  if (!r) return;
  bool right = false;
  if (truth != nullptr) {
    const Vector6 error = (r->T_a_b.mean.inverse() * *truth).log();
    right = error.head<3>().norm() <= kSuccess_m && error.tail<3>().norm() <= kSuccess_rad;
  }
  const Evidence& e = r->evidence;
  std::printf("%s,%d,%.4f,%.4f,%.4f,%d,%.5f,%.5f,%.4f,%.4f,%d,%.5f,%d\n", name.c_str(), right, e.overlap,
              e.inlier_ratio, e.structure_inliers, e.structure_pairs, e.conflict, e.reverse_conflict,
              e.weakest_translation, e.uniqueness, r->accepted, r->probability_correct, r->book_accepted);
}

/// fr_079 and geb079 are maps of the same building: a match of them is not wrong, but nobody
/// measured what is right.
bool one_building(const std::string& a, const std::string& b) { return a.ends_with("079") && b.ends_with("079"); }

void run(unsigned seed) {
  const auto all = pairs(seed);
  std::vector<MapFeatures> a, b;
  for (const auto& pair : all) {
    a.push_back(*MapFeatures::build(*pair.a));
    b.push_back(*MapFeatures::build(*pair.b));
  }
  std::mt19937 random(seed + 1000);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto own = make_matcher("default", a[i], b[i]);
    for (int k = 0; k < 3; ++k) print(all[i].name, **own, start(all[i].T_a_b, 1.5, random), &all[i].T_a_b);
    for (int k = 0; k < 12; ++k) print(all[i].name, **own, start(all[i].T_a_b, 15, random), &all[i].T_a_b);
    std::size_t j = (i + 1 + random() % (all.size() - 1)) % all.size();
    if (one_building(all[i].name, all[j].name)) j = 0;
    const auto other = make_matcher("default", a[i], b[j]);
    const auto own_global = make_matcher("global", a[i], b[i]), other_global = make_matcher("global", a[i], b[j]);
    print(all[i].name, **own_global, {}, &all[i].T_a_b);
    print(all[i].name + "+" + all[j].name, **other_global, {}, nullptr);
    for (int k = 0; k < 6; ++k)
      print(all[i].name + "+" + all[j].name, **other, start(all[i].T_a_b, 15, random), nullptr);
  }
}

}  // namespace
}  // namespace cairn::matching

int main(int argc, char** argv) {
  const auto first = static_cast<unsigned>(argc > 1 ? std::atoi(argv[1]) : 1);
  const auto count = static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1);
  std::printf(
      "pair,right,overlap,inlier_ratio,structure_inliers,structure_pairs,conflict,reverse_conflict,"
      "weakest_translation,uniqueness,accepted,probability,book_accepted\n");
  for (unsigned seed = first; seed < first + count; ++seed) cairn::matching::run(seed);
}
