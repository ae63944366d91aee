// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/pairs/results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "fusion/matching/matcher.hpp"
#include "fusion/matching/methods.hpp"
#include "hal/clock.hpp"
#include "tests/bench/pairs/calibration.hpp"

namespace cairn::pairs {
namespace {

// Bounds of the rows, overlap (4.21), and what they are called.
constexpr std::array kLeast{0.52, 0.375, 0.25, 0.15, 0.07};
constexpr std::array kRowNames{"60 %", "45 %", "30 %", "20 %", "10 %"};

void write(const Answer& x, std::uint64_t seed) {
  const matching::Evidence& e = x.result.evidence;
  std::printf(
      "%s,%s,%.2f,%.1f,%.0f,%.1f,%.3f,%d,%d,%.4f,%.3f,%.3f,%.4f,%d,%.1f,%.0f,%.4f,%.4f,%.4f,%.4f,%.4f,%.0f,%d\n",
      x.type.c_str(), x.kind.c_str(), x.voxel_m, x.moved_m, x.lean_deg, x.dz_m, x.overlap, x.right, x.result.accepted,
      x.result.probability_correct, e.overlap, e.inlier_ratio, e.structure_inliers, e.structure_pairs, e.agreeing_m2,
      e.agreeing_floor_m2, e.conflict, e.reverse_conflict, e.weakest_translation, e.uniqueness, e.score, x.ms,
      static_cast<int>(seed));
  std::fflush(stdout);
}

}  // namespace

std::array<double, 2> memory_mb() {
  std::ifstream status("/proc/self/status");
  std::array<double, 2> mb{};
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) mb[0] = std::atof(line.c_str() + 6) / 1024;
    if (line.starts_with("VmHWM:")) mb[1] = std::atof(line.c_str() + 6) / 1024;
  }
  std::ofstream("/proc/self/clear_refs") << "5";
  return mb;
}

Results::Results(bool csv) : csv_(csv) {
  if (csv)
    std::puts(
        "type,kind,voxel,moved,lean,dz,true_overlap,right,accepted,p,overlap,inlier_ratio,structure_inliers,"
        "structure_pairs,agreeing_m2,floor_m2,conflict,reverse_conflict,weakest,uniqueness,score,ms,"
        "seed");
}

void Results::match(Answer about, const Chart& a, const Chart& b, const std::optional<UncertainPose>& initial,
                    std::uint64_t seed) {
  Budget budget = Budget::steps(matching::kAmpleSteps);
  const Duration start = thread_cpu_time();
  about.result = *(*matching::make_matcher("default", *a.features, *b.features))->match(initial, budget);
  about.ms = 1e3 * to_seconds(thread_cpu_time() - start);
  const bool one_place = about.type == "global" || about.type == "local";
  about.right = one_place && is_right(a, b, about.result.T_a_b.mean);
  if (csv_) write(about, seed);
  all_.push_back(std::move(about));
}

template <class Which>
void Results::row(const std::string& name, const Which& which) const {
  int n = 0, right = 0, accepted = 0, wrongly = 0;
  double ms = 0, most = 0;
  for (const Answer& x : all_) {
    if (!which(x)) continue;
    ++n;
    right += x.right ? 1 : 0;
    accepted += x.right && x.result.accepted ? 1 : 0;
    wrongly += !x.right && x.result.accepted ? 1 : 0;
    ms += x.ms;
    most = std::max(most, x.ms);
  }
  if (n == 0) return;
  std::printf("  %-28s %5d  right %5d (%5.1f %%)  accepted %5d (%5.1f %%)  wrongly %3d  %5.0f ms, at most %5.0f\n",
              name.c_str(), n, right, 100.0 * right / n, accepted, right > 0 ? 100.0 * accepted / right : 0, wrongly,
              ms / n, most);
}

/// Negatives weigh together as much as the others do.
void Results::calibrated(double voxel_m) const {
  double one_place = 0, other = 0;
  const auto is_one = [](const Answer& x) { return x.type == "global" || x.type == "local"; };
  const auto is_other = [](const Answer& x) { return x.type == "plain" || x.type == "mirrored"; };
  for (const Answer& x : all_) {
    if (x.voxel_m != voxel_m) continue;
    one_place += is_one(x) ? 1 : 0;
    other += is_other(x) ? 1 : 0;
  }
  std::vector<Judged> answers;
  for (const Answer& x : all_)
    if (x.voxel_m == voxel_m && (is_one(x) || is_other(x)))
      answers.push_back(
          {.weight = is_one(x) ? 1 : one_place / other, .p = x.result.probability_correct, .right = x.right});
  if (answers.empty()) return;
  const Calibration found = calibration(answers);
  std::printf(
      "  voxels of %.2f m: calibration error (ECE) %.3f of %zu answers; true probabilities: %.3f, rarely over %.3f\n",
      voxel_m, found.error, answers.size(), found.by_chance, found.rarely_over);
}

void Results::print() const {
  for (const std::string type : {"global", "local"}) {
    for (std::size_t i = 0; i < kLeast.size(); ++i)
      row(type + ", overlap " + kRowNames[i], [&](const Answer& x) {
        return x.type == type && x.overlap >= kLeast[i] && (i == 0 || x.overlap < kLeast[i - 1]);
      });
    for (const double lean : {1.0, 5.0, 8.0})
      row(type + ", leaning " + std::to_string(static_cast<int>(lean)) + " deg",
          [&](const Answer& x) { return x.type == type && x.lean_deg == lean && x.overlap >= kLeast[3]; });
    for (const double moved : kMoved_m)
      row(type + ", moved objects " + std::to_string(moved).substr(0, 3) + " m",
          [&](const Answer& x) { return x.type == type && x.moved_m == moved && x.overlap >= kLeast[3]; });
    for (const std::string kind : kKindNames)
      row(type + ", " + kind,
          [&](const Answer& x) { return x.type == type && x.kind == kind && x.overlap >= kLeast[3]; });
    row(type + ", all", [&](const Answer& x) { return x.type == type && x.overlap >= kLeast.back(); });
  }
  for (const std::string type : {"plain", "mirrored", "symmetric", "copy", "turned"})
    row(type, [&](const Answer& x) { return x.type == type; });
  for (const double voxel : kVoxels_m) calibrated(voxel);
  std::printf("  %.0f MB of memory at most\n", memory_mb()[1]);
  std::fflush(stdout);
}

}  // namespace cairn::pairs
