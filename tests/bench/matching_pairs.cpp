// SPDX-License-Identifier: Apache-2.0
// One look at two maps: how often the pose is right, how often it is accepted, how honest its probability is.
//   matching_pairs [FIRST_SEED] [SEEDS] [csv]        5004 27
//   matching_pairs low [FIRST_SEED] [SEEDS] [csv]    5100 27: small overlaps only, without a guess
//   matching_pairs town [SEED]                       two whole maps of 400 m: time and memory
// Each seed is a place (rooms, a hall, outdoors), a voxel size (0.05, 0.1, 0.2 m) and moved objects (none, 0.5, 1.2
// m). Nine seeds in a row share the voxel size. So 27 seeds from a multiple of nine have all of them alike. Robot a
// maps a part of it. Robot b maps four other parts, each with another share of a's. Its frame has any heading, up
// to 17 m of height, and leans up to 1, 5 or 8 degrees. A fifth of the occupied voxels of both is missing. Each
// pair is matched without a guess, and from one that is off by up to 2 m and 15 degrees. Each map of b is matched
// with a's mirror image and with maps of other places, too, where every answer is wrong. So are those for two
// copies of a furnished room, and for the halves of a half-turned building. A quarter of the halls is symmetric but
// for its furniture. Their mirror images have a row of their own. Seeds below 5000 are for fitting only. Figures
// are from the others.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "fusion/matching/matcher.hpp"
#include "fusion/matching/methods.hpp"
#include "hal/clock.hpp"
#include "tests/bench/missions/building.hpp"
#include "tests/bench/pairs/chart.hpp"
#include "tests/bench/pairs/grounds.hpp"
#include "tests/bench/pairs/results.hpp"
#include "tests/bench/pairs/survey.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::pairs {
namespace {

using matching::MapFeatures;
using simulator::Random;
using Stops = simulator::Path;

// What is measured, not tuned.
constexpr std::array kKinds{Kind::kRooms, Kind::kHall, Kind::kOutdoor};
constexpr std::array kRange_m{8.0, 8.0, 14.0};
// Of a's stops, that are b's as well. The second is of small overlaps: b begins where a ends, or farther on.
constexpr std::array kShared{0.8, 0.5, 0.25, 0.05}, kHardlyShared{0.1, 0.0, -0.1, -0.2};
constexpr int kObjects = 8;
constexpr std::size_t kNegatives = 3;  // other places, for each map of b

/// The places and robots of one seed.
class Round {
 public:
  /// `low`: small overlaps only.
  Round(std::uint64_t seed, bool low, Results& results, std::deque<Chart>& others)
      : seed_(seed), low_(low), random_(seed, 71), results_(results), others_(others) {
    about_.kind = kKindNames[seed % 3];
    about_.moved_m = kMoved_m[seed / 3 % 3];
    about_.voxel_m = kVoxels_m[seed / 9 % 3];
    const double draw = random_.uniform();
    about_.lean_deg = draw < 0.6 ? 1 : draw < 0.85 ? 5 : 8;
    how_.voxel_m = about_.voxel_m;
    how_.range_m = kRange_m[seed % 3];
  }

  void run() {
    const Ground of_a = visit(1), of_b = visit(2);
    const double heading = random_.uniform(0, 2 * std::numbers::pi), end = random_.uniform(0.5, 0.62);
    const Stops stops_a = part(of_a.world, heading, 0, end, random_);
    Chart a = robot(of_a, stops_a, 0.5, 0.5, 1);
    how_.mirrored = true;
    const Chart mirrored = robot(of_a, stops_a, 0.5, 0.5, 1);
    how_.mirrored = false;
    for (std::size_t i = 0; i < kShared.size(); ++i) {
      const double begin = end * (1 - (low_ ? kHardlyShared : kShared)[i]);
      const Stops stops_b = part(of_b.world, heading, begin, begin + end, random_);
      compare(a, mirrored, robot(of_b, stops_b, 17, about_.lean_deg, 2 + i));
    }
    if (!low_) copies();
    if (!low_ && about_.kind == "rooms") turned();
    others_.push_back(std::move(a));
    if (others_.size() > 8) others_.pop_front();
  }

 private:
  [[nodiscard]] Ground visit(std::uint64_t which) const {
    simulator::World world = make_ground(kKinds[seed_ % 3], seed_);
    if (about_.moved_m > 0) add_objects(world, kObjects, about_.moved_m, 10 * seed_ + which);
    return Ground(std::move(world));
  }

  Chart robot(const Ground& ground, const Stops& stops, double height_m, double lean_deg, std::uint64_t which) {
    Survey how = how_;
    how.seed = 100 * seed_ + which;
    const Eigen::Vector2d p = stops.empty() ? Eigen::Vector2d::Zero() : stops.front();
    how.T_map_world = frame(random_, height_m, lean_deg, {p.x(), p.y(), ground.world.ground(p.x(), p.y())});
    return chart(ground, stops, how);
  }

  void compare(const Chart& a, const Chart& mirrored, const Chart& b) {
    Answer about = about_;
    about.overlap = overlap(a, b);
    about.dz_m = (a.T_map_world * b.middle - b.T_map_world * b.middle).z();
    ask(about, "global", a, b, {});
    if (low_) return;
    ask(about, "local", a, b, guess(a, b, random_));
    about.overlap = 0;
    const bool symmetric = about_.kind == "hall" && seed_ % 4 == 0;
    ask(about, symmetric ? "symmetric" : "mirrored", mirrored, b, {});
    const std::size_t first = others_.empty() ? 0 : random_.below(others_.size());
    for (std::size_t k = 0; k < std::min(kNegatives, others_.size()); ++k)
      ask(about, "plain", others_[(first + k) % others_.size()], b, {});
  }

  void ask(Answer about, const char* type, const Chart& a, const Chart& b, const std::optional<UncertainPose>& guess) {
    about.type = type;
    results_.match(std::move(about), a, b, guess, seed_);
  }

  void copies() {
    const Ground one(make_room(seed_, 2 * seed_)), other(make_room(seed_, 2 * seed_ + 1));
    const Chart a = robot(one, one.world.places, 0.5, 0.5, 11), b = robot(other, other.world.places, 2, 1, 12);
    ask(about_, "copy", a, b, {});
  }

  void turned() {
    const Ground ground(missions::make_building(missions::Copies::kHalfTurn, seed_));
    const Stops left = part(ground.world, 0, 0, 0.42, random_), right = part(ground.world, 0, 0.58, 1, random_);
    const Chart a = robot(ground, left, 0.5, 0.5, 13), b = robot(ground, right, 2, 1, 14);
    ask(about_, "turned", a, b, {});
  }

  std::uint64_t seed_;
  bool low_;
  Random random_;
  Results& results_;
  std::deque<Chart>& others_;
  Answer about_;
  Survey how_;
};

void run(std::uint64_t first, int seeds, bool low, bool csv) {
  Results results(csv);
  std::deque<Chart> others;  // of the same voxel size
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(seeds); ++seed) {
    if (seed % 9 == 0) others.clear();
    Round(seed, low, results, others).run();
  }
  if (!csv)
    std::printf("matching_pairs, seeds %d to %d\n", static_cast<int>(first), static_cast<int>(first) + seeds - 1);
  if (!csv) results.print();
}

void town(std::uint64_t seed) {
  const Ground ground(make_ground(Kind::kTown, seed));
  Random random(seed, 72);
  std::array<Stops, 2> stops;
  for (const Eigen::Vector2d& p : ground.world.places)
    for (int i = 0; i < 2; ++i)
      if (random.uniform() < 0.4)
        stops[static_cast<std::size_t>(i)].push_back(p + Eigen::Vector2d(random.uniform(-2, 2), random.uniform(-2, 2)));
  std::array<Chart, 2> charts;
  for (std::size_t i = 0; i < 2; ++i) {
    Survey how{.T_map_world = frame(random, 5, 1, {200, 200, 0}), .voxel_m = 0.2, .range_m = 14, .seed = seed + i};
    charts[i] = chart(ground, stops[i], how);
    charts[i].features.reset();
  }
  const double before = memory_mb()[0];
  const Duration start = thread_cpu_time();
  for (Chart& c : charts) c.features = std::make_unique<MapFeatures>(*MapFeatures::build(*c.map));
  const double features_s = to_seconds(thread_cpu_time() - start);
  Budget budget = Budget::steps(matching::kAmpleSteps);
  const auto found =
      (*matching::make_matcher("default", *charts[0].features, *charts[1].features))->match(std::nullopt, budget);
  const double all_s = to_seconds(thread_cpu_time() - start);
  std::printf(
      "town %d: %zu and %zu surfels, overlap %.2f; %s, probability %.3f (%s); features %.2f s, all %.2f s of "
      "CPU; %.0f MB at most, %.0f MB of them the two maps\n",
      static_cast<int>(seed), charts[0].features->fine().size(), charts[1].features->fine().size(), found->overlap,
      is_right(charts[0], charts[1], found->T_a_b.mean) ? "right" : "wrong", found->probability_correct,
      found->reason.c_str(), features_s, all_s, memory_mb()[1], before);
  std::fflush(stdout);
}

}  // namespace
}  // namespace cairn::pairs

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
  const auto is = [&](const char* mode) { return argc > 1 && std::strcmp(argv[1], mode) == 0; };
  if (is("town")) {
    cairn::pairs::town(static_cast<std::uint64_t>(number(2, 5000)));
    return 0;
  }
  const int at = is("low") ? 2 : 1;
  cairn::pairs::run(static_cast<std::uint64_t>(number(at, is("low") ? 5100 : 5004)), number(at + 1, 27), is("low"),
                    argc > at + 2);
}
