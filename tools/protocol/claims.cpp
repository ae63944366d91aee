// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/claims.hpp"

#include <fmt/format.h>

#include "tools/protocol/figures.hpp"

namespace cairn::protocol {
namespace {

void add_default(const PairOutcome& scene, std::vector<Claim>& claims) {
  const MethodRun* run = scene.run("default");
  if (run == nullptr) return;
  const Figures f = figures_of(run->attempts);
  const double most_m = scene.pair.name == "office" ? 0.01 : 0.02;
  claims.push_back({fmt::format("{}: the default succeeds from ≥ 99 % of the starts, off by ≤ {} m and ≤ 0.1°",
                                scene.pair.name, most_m),
                    fmt::format("{:.1f} %, {:.4f} m, {:.3f}°", 100 * f.success, f.mean_error_m, f.mean_error_deg),
                    f.success >= 0.99 && f.mean_error_m <= most_m && f.mean_error_deg <= 0.1});
  claims.push_back({fmt::format("{}: the default takes ≤ 0.1 s a match", scene.pair.name),
                    fmt::format("{:.3f} s, at most {:.3f} s, and {:.2f} s once to prepare the pair", f.seconds,
                                f.slowest_s, run->preparation_s),
                    f.seconds <= 0.1});
}

/// The lesser number is to be the first one's.
Claim less(std::string claim, double first, double second, const char* unit, int digits) {
  return {std::move(claim), fmt::format("{:.{}f} against {:.{}f}{}", first, digits, second, digits, unit),
          first < second};
}

void add_entropies(const PairOutcome& scene, std::vector<Claim>& claims) {
  const FusedEntropy *filter = scene.entropy("relative_entropy"), *average = scene.entropy("average"),
                     *stitch = scene.entropy("stitch");
  if (filter == nullptr || average == nullptr || stitch == nullptr) return;
  const FusedEntropy* both = scene.entropy("side_by_side");
  const std::string in = " (" + scene.pair.name + ", ";
  claims.push_back(less("relative entropy < average" + in + "binary entropy)", filter->binary, average->binary, "", 4));
  claims.push_back(less("relative entropy < average" + in + "−p log2 p)", filter->book, average->book, "", 4));
  claims.push_back(less("average < stitch" + in + "binary entropy)", average->binary, stitch->binary, "", 4));
  claims.push_back(less("average < stitch" + in + "−p log2 p)", average->book, stitch->book, "", 4));
  if (both != nullptr)
    claims.push_back(
        less("relative entropy < both maps side by side" + in + "−p log2 p)", filter->book, both->book, "", 4));
}

void add_edges(const PairOutcome& scene, std::vector<Claim>& claims) {
  const MethodRun *level1 = scene.run("pmm_level1"), *icp = scene.run("edge_icp");
  if (level1 == nullptr || icp == nullptr) return;
  const Figures a = figures_of(level1->attempts), b = figures_of(icp->attempts);
  claims.push_back(less("PMM level 1 takes fewer iterations than ICP on edges (" + scene.pair.name + ")", a.iterations,
                        b.iterations, "", 1));
  claims.push_back(less("ICP on edges succeeds from fewer starts than PMM level 1 (" + scene.pair.name + ")",
                        100 * b.success, 100 * a.success, " %", 1));
}

void add_heterogeneous(const Outcome& outcome, std::vector<Claim>& claims) {
  double before = 0;
  bool falling = true;
  std::string counts;
  for (const char* phase : {"start", "middle", "end"})
    for (const PairOutcome* p : outcome.of_kind(kHeterogeneous)) {
      const MethodRun *oicp = p->run("oicp"), *em = p->run("em");
      if (!p->pair.name.ends_with(phase) || oicp == nullptr || em == nullptr) continue;
      const Figures a = figures_of(oicp->attempts), b = figures_of(em->attempts);
      if (std::string(phase) == "start")
        claims.push_back({"EM's RMS is ≤ 0.9 of OICP's while the LiDAR's map is sparse",
                          fmt::format("{:.4f} against {:.4f} m", b.rms_m, a.rms_m), b.rms_m <= 0.9 * a.rms_m});
      claims.push_back({fmt::format("EM succeeds from ≥ 95 % of the starts ({})", phase),
                        fmt::format("{:.1f} %", 100 * b.success), b.success >= 0.95});
      const double now = em->correspondences.value_or(1);
      falling = falling && (counts.empty() || now < before);
      counts += fmt::format("{}{:.2f}", counts.empty() ? "" : ", ", now);
      before = now;
    }
  if (!counts.empty()) claims.push_back({"EM's correspondences fall as the LiDAR's map fills", counts, falling});
}

void add_overlaps(const Outcome& outcome, std::vector<Claim>& claims) {
  for (const PairOutcome* p : outcome.of_kind(kOverlap)) {
    const MethodRun* run = p->run("default");
    if (run == nullptr || p->pair.overlap < 0.195) continue;
    const double success = figures_of(run->attempts).success;
    claims.push_back({fmt::format("{} at {:.0f} % overlap: the default succeeds from ≥ 90 % of the starts",
                                  p->pair.scene, 100 * p->pair.overlap),
                      fmt::format("{:.0f} %", 100 * success), success >= 0.9});
  }
}

}  // namespace

std::vector<Claim> claims_of(const Outcome& outcome) {
  std::vector<Claim> claims;
  const auto scenes = outcome.of_kind(kScene);
  for (const PairOutcome* scene : scenes) add_default(*scene, claims);
  add_overlaps(outcome, claims);
  for (const PairOutcome* scene : scenes) add_entropies(*scene, claims);
  for (const PairOutcome* scene : scenes) add_edges(*scene, claims);
  add_heterogeneous(outcome, claims);
  return claims;
}

}  // namespace cairn::protocol
