// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tools/protocol/report/figures.hpp"
#include "tools/protocol/unlike/label_tables.hpp"
#include "tools/protocol/unlike/unlike_tables.hpp"

namespace cairn::protocol {
namespace {

Claim below_both(std::string claim, double a, double b, double fused) {
  return {std::move(claim), fmt::format("{:.4f} against {:.4f} and {:.4f}", fused, a, b), fused < a && fused < b};
}

/// Of occupancy, label and both. Nothing is claimed of what no voxel has.
void add_entropies(const std::string& where, const EntropiesOfThree& e, std::vector<Claim>& claims) {
  if (e.fused.occupied == 0) return;
  claims.push_back(below_both(where + ": the fused entropy of occupancy is below each robot's own", e.a.occupancy,
                              e.b.occupancy, e.fused.occupancy));
  if (e.fused.labelled == 0) return;
  claims.push_back(below_both(where + ": the fused entropy of labels is below each robot's own", e.a.label, e.b.label,
                              e.fused.label));
  claims.push_back(below_both(where + ": the fused entropy of both is below each robot's own", e.a.overall(),
                              e.b.overall(), e.fused.overall()));
}

void add_poses(const std::string& scene, const std::vector<const UnlikeOutcome*>& fusions, std::vector<Claim>& claims) {
  const Attempt& last = fusions.back()->attempt;
  claims.push_back({scene + ": the match of the last fusion is within 0.6 m and 6° of the truth",
                    fmt::format("{:.3f} m, {:.2f}°", last.error.m, last.error.deg), last.error.success()});
  claims.push_back({scene + ": the match of the last fusion is accepted, as right",
                    last.accepted ? "accepted" : "not accepted", last.accepted && last.error.success()});
}

void add_times(const std::string& scene, const std::vector<const UnlikeOutcome*>& fusions, std::vector<Claim>& claims) {
  double slowest = 0, gap = fusions.front()->moment.seconds;
  for (std::size_t i = 0; i < fusions.size(); ++i) {
    slowest = std::max(slowest, fusions[i]->seconds("default"));
    if (i > 0) gap = std::min(gap, fusions[i]->moment.seconds - fusions[i - 1]->moment.seconds);
  }
  claims.push_back({scene + ": a fusion takes less time than there is between two",
                    fmt::format("at most {:.2f} s of {:.1f} s", slowest, gap), slowest < gap});
}

void add_book(const std::string& scene, const std::vector<const UnlikeOutcome*>& fusions, std::vector<Claim>& claims) {
  std::string rms, counts;
  bool em_better = true, any = false;
  double first = 0, last = 0;
  for (const UnlikeOutcome* o : three_times(fusions)) {
    const MethodRun *oicp = o->outcome.run("oicp"), *em = o->outcome.run("em");
    if (oicp == nullptr || em == nullptr) continue;
    const double a = figures_of(oicp->attempts).rms_m, b = figures_of(em->attempts).rms_m;
    if (a <= 0 || b <= 0) continue;  // no voxel had a partner
    rms += fmt::format("{}{:.4f} against {:.4f}", any ? ", " : "", b, a);
    em_better = em_better && b < a;
    if (!any) first = b;
    last = b;
    any = true;
  }
  if (!any) return;
  claims.push_back({scene + ": the RMS of Cairn's EM is below OICP's at the beginning, in the middle and at the end",
                    rms + " m", em_better, true});
  if (fusions.size() < 2) return;
  claims.push_back({scene + ": the RMS of Cairn's EM falls from the beginning to the end",
                    fmt::format("{:.4f} to {:.4f} m", first, last), last < first, true});
  const auto count = [](const UnlikeOutcome* o) {
    const MethodRun* em = o->outcome.run("em");
    return em != nullptr ? em->correspondences.value_or(1) : 1;
  };
  const double begins = count(fusions.front()), ends = count(fusions.back());
  claims.push_back({scene + ": the correspondences of Cairn's EM fall as the maps fill",
                    fmt::format("{:.2f} to {:.2f}", begins, ends), ends < begins, true});
}

void add_labels(std::string_view table, std::vector<Claim>& claims) {
  int rows = 0, classes = 0, evenly = 0, shared = 0;
  for (const FusedLabelRow& row : fused_label_rows()) {
    if (row.book.table != table) continue;
    ++rows;
    classes += row.class_id == row.book.fused_class ? 1 : 0;
    evenly += same_to_third_decimal(row.evenly, row.book.fused_p) ? 1 : 0;
    shared += row.share && same_to_third_decimal(row.with_share, row.book.fused_p) ? 1 : 0;
  }
  const auto add = [&](const char* text, int right) {
    claims.push_back(
        {fmt::format("Table {}: {}", table, text), fmt::format("{} of {} rows", right, rows), right == rows});
  };
  add("the fused class is the book's", classes);
  add("its probability is the book's to the third decimal, with one share chosen for each row", shared);
  add("its probability is the book's to the third decimal, with nothing chosen", evenly);
}

}  // namespace

std::vector<Claim> unlike_claims(const std::vector<UnlikeOutcome>& all) {
  std::vector<Claim> claims;
  for (const UnlikeOutcome& o : all)
    if (o.entropies) add_entropies(o.scene(), o.entropies->whole, claims);
  for (const UnlikeOutcome& o : all)
    if (o.entropies) add_entropies(o.scene() + ", voxels with a partner", o.entropies->shared, claims);
  for (const UnlikeOutcome& o : all)
    if (o.entropies) add_entropies(o.scene() + ", as a team fuses", o.entropies->told, claims);
  for (const char* table : {"7.3", "7.4"}) add_labels(table, claims);
  for (const std::string& scene : scenes_of(all)) {
    const auto fusions = fusions_of(all, scene);
    add_poses(scene, fusions, claims);
    add_times(scene, fusions, claims);
    add_book(scene, fusions, claims);
  }
  return claims;
}

}  // namespace cairn::protocol
