// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/claims.hpp"

#include <fmt/format.h>

#include <map>

#include "tools/protocol/report/figures.hpp"

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
          first < second, true};
}

/// By both of the entropies that the tables give.
Claim less(std::string claim, const FusedEntropy& first, const FusedEntropy& second) {
  return {std::move(claim),
          fmt::format("{:.4f} against {:.4f} bit; as −p log2 p {:.4f} against {:.4f}", first.binary, second.binary,
                      first.book, second.book),
          first.binary < second.binary && first.book < second.book, true};
}

void add_entropies(const PairOutcome& scene, std::vector<Claim>& claims) {
  const FusedEntropy *filter = scene.entropy("relative_entropy"), *average = scene.entropy("average"),
                     *stitch = scene.entropy("stitch"), *both = scene.entropy("side_by_side");
  if (filter == nullptr || average == nullptr || stitch == nullptr) return;
  const std::string where = scene.pair.name + ": fused entropy of ";
  claims.push_back(less(where + "relative entropy < average", *filter, *average));
  claims.push_back(less(where + "average < stitch", *average, *stitch));
  if (both != nullptr) claims.push_back(less(where + "relative entropy < both maps side by side", *filter, *both));
}

void add_edges(const PairOutcome& scene, std::vector<Claim>& claims) {
  const MethodRun *level1 = scene.run("pmm_level1"), *icp = scene.run("edge_icp");
  if (level1 == nullptr || icp == nullptr) return;
  const Figures a = figures_of(level1->attempts), b = figures_of(icp->attempts);
  claims.push_back(less(scene.pair.name + ": PMM level 1 takes fewer iterations than ICP on edges", a.iterations,
                        b.iterations, "", 1));
  claims.push_back(less(scene.pair.name + ": ICP on edges succeeds from fewer starts than PMM level 1", 100 * b.success,
                        100 * a.success, " %", 1));
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
        claims.push_back({"the RMS of Cairn's EM is ≤ 0.9 of OICP's while the LiDAR's map is sparse",
                          fmt::format("{:.4f} against {:.4f} m", b.rms_m, a.rms_m), b.rms_m <= 0.9 * a.rms_m});
      claims.push_back({fmt::format("Cairn's EM succeeds from ≥ 95 % of the starts ({})", phase),
                        fmt::format("{:.1f} %", 100 * b.success), b.success >= 0.95});
      const double now = em->correspondences.value_or(1);
      falling = falling && (counts.empty() || now < before);
      counts += fmt::format("{}{:.2f}", counts.empty() ? "" : ", ", now);
      before = now;
    }
  if (!counts.empty())
    claims.push_back({"the correspondences of Cairn's EM fall as the LiDAR's map fills", counts, falling});
}

/// One for each scene, over the steps of its overlap down to 20 %.
void add_overlaps(const Outcome& outcome, std::vector<Claim>& claims) {
  std::map<std::string, Claim> by_scene;
  for (const PairOutcome* p : outcome.by_falling_overlap()) {
    const MethodRun* run = p->run("default");
    if (run == nullptr || p->pair.overlap < 0.195) continue;
    const double success = figures_of(run->attempts).success;
    const auto [at, first] = by_scene.try_emplace(
        p->pair.scene,
        Claim{p->pair.scene + ": the default succeeds from ≥ 90 % of the starts at each overlap down to 20 %", "",
              true});
    Claim& claim = at->second;
    claim.figures += fmt::format("{}{:.1f} % at {:.0f} %", first ? "" : ", ", 100 * success, 100 * p->pair.overlap);
    claim.holds = claim.holds && success >= 0.9;
  }
  for (auto& [scene, claim] : by_scene) claims.push_back(std::move(claim));
}

}  // namespace

std::vector<Claim> claims_of(const Outcome& outcome) {
  std::vector<Claim> claims;
  const auto scenes = outcome.of_kind(kScene);
  for (const PairOutcome* scene : scenes) add_default(*scene, claims);
  add_overlaps(outcome, claims);
  add_heterogeneous(outcome, claims);
  for (const PairOutcome* scene : scenes) add_entropies(*scene, claims);
  for (const PairOutcome* scene : scenes) add_edges(*scene, claims);
  return claims;
}

}  // namespace cairn::protocol
