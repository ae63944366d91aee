// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tools/protocol/pairs/book.hpp"
#include "tools/protocol/report/figures.hpp"

namespace cairn::protocol {
namespace {

using Cell = std::function<std::string(const PairOutcome&, const MethodRun&)>;

/// One row for each method that ran, one column for each scene.
Table by_method(const Outcome& outcome, std::string title, std::string note, const Cell& cell) {
  Table table{std::move(title), std::move(note), {"method"}, {}};
  const auto scenes = outcome.of_kind(kScene);
  for (const PairOutcome* scene : scenes) table.header.push_back(scene->pair.name);
  for (const std::string_view method : table_methods()) {
    std::vector<std::string> row{std::string(title_of(method))};
    bool any = false;
    for (const PairOutcome* scene : scenes) {
      const MethodRun* run = scene->run(method);
      any = any || run != nullptr;
      row.push_back(run != nullptr ? cell(*scene, *run) : "–");
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

const BookScene* book_scene(const PairOutcome& scene) {
  for (const BookScene& b : kBookScenes)
    if (b.name == scene.pair.name) return &b;
  return nullptr;
}

}  // namespace

Table scenes_table(const Outcome& outcome) {
  Table table{"The maps (book: Table 4.2)",
              "Overlap: share of occupied voxels with one of the other map within the diagonal of a voxel, mean over "
              "both maps (4.21).",
              {"scene", "voxels a", "voxels b", "edges a", "edges b", "overlap", "book: voxels", "edges", "overlap"},
              {}};
  for (const PairOutcome* scene : outcome.of_kind(kScene)) {
    const MapPair& p = scene->pair;
    const BookScene* book = book_scene(*scene);
    const auto known = [&](auto value) { return book != nullptr ? fmt::format("{}", value(*book)) : "–"; };
    table.rows.push_back({p.name, fmt::format("{}", p.voxels_a), fmt::format("{}", p.voxels_b),
                          fmt::format("{}", p.edges_a), fmt::format("{}", p.edges_b), fmt::format("{:.2f}", p.overlap),
                          known([](const BookScene& b) { return b.voxels; }),
                          known([](const BookScene& b) { return b.edges; }),
                          known([](const BookScene& b) { return b.overlap; })});
  }
  return table;
}

Table success_table(const Outcome& outcome) {
  return by_method(outcome, "Success, % of the starts (book: Fig. 4.12)",
                   outcome.starts_told(kScene) + "Success: at most 0.6 m and 6° from the truth.",
                   [](const PairOutcome&, const MethodRun& run) {
                     return fmt::format("{:.1f}", 100 * figures_of(run.attempts).success);
                   });
}

Table errors_table(const Outcome& outcome) {
  return by_method(outcome, "Mean error over all starts, ° and m (book: Table 4.3)",
                   "In parentheses the book's numbers for its own maps; those of full PMM are not in its text.",
                   [](const PairOutcome& scene, const MethodRun& run) {
                     const Figures f = figures_of(run.attempts);
                     std::string cell = fmt::format("{:.2f} {:.3f}", f.mean_error_deg, f.mean_error_m);
                     if (const auto book = book_error(scene.pair.name, run.method))
                       cell += fmt::format(" ({:.2f} {:.2f})", book->deg, book->m);
                     return cell;
                   });
}

Table success_errors_table(const Outcome& outcome) {
  return by_method(outcome, "Mean error over successes, ° and m", "", [](const PairOutcome&, const MethodRun& run) {
    const Figures f = figures_of(run.attempts);
    return f.success > 0 ? fmt::format("{:.3f} {:.4f}", f.success_error_deg, f.success_error_m) : "–";
  });
}

Table times_table(const Outcome& outcome) {
  return by_method(outcome, "CPU time of a match, s, + preparation of the pair, s (book: Table 4.4)",
                   "In parentheses the book's numbers for ICP; its others are not in its text.",
                   [](const PairOutcome& scene, const MethodRun& run) {
                     std::string cell =
                         fmt::format("{:.3f} + {:.2f}", figures_of(run.attempts).seconds, run.preparation_s);
                     const BookScene* book = book_scene(scene);
                     if (book != nullptr && run.method == "icp") cell += fmt::format(" ({:.2f})", book->icp_seconds);
                     return cell;
                   });
}

Table entropies_table(const Outcome& outcome) {
  Table table{
      "Entropy of the fused map, bits: binary / as −p log2 p (book: Tables 3.2 and 4.5)",
      "Mean over the fused map's occupied voxels, maps laid over each other at the true pose; Jessup: at the "
      "pose that PCL's ICP finds from there. The book: average 0.16 and relative entropy 0.13 (simulation), "
      "0.24 and 0.20 (WKW lobby); its numbers of Table 4.5 are not in its text. Entropy is concave: an average is at "
      "least as uncertain as what it was taken of, so it can only fall below a stitched map by voxels that "
      "leave the map.",
      {"policy"},
      {}};
  const auto scenes = outcome.of_kind(kScene);
  for (const PairOutcome* scene : scenes) table.header.push_back(scene->pair.name);
  struct Policy {
    const char *name, *title;
  };
  for (const Policy& policy :
       {Policy{"side_by_side", "stitch, both maps' voxels"}, Policy{"stitch", "stitch, the first map's"},
        Policy{"jessup", "ICP + average (Jessup)"}, Policy{"average", "average"},
        Policy{"relative_entropy", "relative entropy"},
        Policy{"relative_entropy_weighted", "relative entropy, self-weighted"}, Policy{"bayes", "Bayes"}}) {
    std::vector<std::string> row{policy.title};
    for (const PairOutcome* scene : scenes) {
      const FusedEntropy* e = scene->entropy(policy.name);
      row.push_back(e != nullptr ? fmt::format("{:.4f} / {:.4f}", e->binary, e->book) : "–");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table edges_table(const Outcome& outcome) {
  Table table{
      "Structural edges alone: PMM level 1 against ICP (book: section 4.6.2)",
      "The book: about 15 iterations against more than 25, and the wider basin.",
      {"scene", "iterations level 1", "edge ICP", "success level 1, %", "edge ICP", "error level 1, m", "edge ICP"},
      {}};
  for (const PairOutcome* scene : outcome.of_kind(kScene)) {
    const MethodRun *level1 = scene->run("pmm_level1"), *icp = scene->run("edge_icp");
    if (level1 == nullptr || icp == nullptr) continue;
    const Figures a = figures_of(level1->attempts), b = figures_of(icp->attempts);
    table.rows.push_back({scene->pair.name, fmt::format("{:.1f}", a.iterations), fmt::format("{:.1f}", b.iterations),
                          fmt::format("{:.1f}", 100 * a.success), fmt::format("{:.1f}", 100 * b.success),
                          fmt::format("{:.3f}", a.mean_error_m), fmt::format("{:.3f}", b.mean_error_m)});
  }
  return table;
}

Table overlap_table(const Outcome& outcome) {
  Table table{"Less and less overlap: success, % / mean error, m (book: Fig. 4.10)",
              outcome.starts_told(kOverlap),
              {"scene", "overlap"},
              {}};
  std::vector<std::string_view> methods;
  const auto pairs = outcome.by_falling_overlap();
  for (const std::string_view m : table_methods())
    if (std::any_of(pairs.begin(), pairs.end(), [&](const PairOutcome* p) { return p->run(m) != nullptr; }))
      methods.push_back(m);
  for (const std::string_view m : methods) table.header.emplace_back(title_of(m));
  for (const PairOutcome* p : pairs) {
    std::vector<std::string> row{p->pair.scene, fmt::format("{:.2f}", p->pair.overlap)};
    for (const std::string_view m : methods) {
      const MethodRun* run = p->run(m);
      const Figures f = run != nullptr ? figures_of(run->attempts) : Figures{};
      row.push_back(run != nullptr ? fmt::format("{:.0f} / {:.2f}", 100 * f.success, f.mean_error_m) : "–");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table rms_table(const Outcome& outcome) {
  Table table{"A LiDAR's map that fills, on a depth camera's map: RMS of matched voxels, m (book: Table 5.2)",
              outcome.starts_told(kHeterogeneous) +
                  "Voxels with a partner within 1 m, mean over the starts. EM as printed: Algorithm 3. The book, "
                  "indoors: OICP 0.341, 0.259, 0.268, EM "
                  "0.248, 0.236, 0.289; 3.57 correspondences falling to 2.15.",
              {"LiDAR's map", "voxels", "RMS OICP", "EM as printed", "Cairn's EM", "Cairn's EM / OICP",
               "success OICP, %", "EM as printed", "Cairn's EM", "default", "Cairn's EM's correspondences"},
              {}};
  for (const char* phase : {"start", "middle", "end"})
    for (const PairOutcome* p : outcome.of_kind(kHeterogeneous)) {
      const MethodRun *oicp = p->run("oicp"), *printed = p->run("em_book"), *em = p->run("em"),
                      *ours = p->run("default");
      if (!p->pair.name.ends_with(phase) || !oicp || !printed || !em || !ours) continue;
      const Figures a = figures_of(oicp->attempts), b = figures_of(em->attempts), c = figures_of(ours->attempts),
                    d = figures_of(printed->attempts);
      table.rows.push_back({phase, fmt::format("{}", p->pair.voxels_b), fmt::format("{:.4f}", a.rms_m),
                            fmt::format("{:.4f}", d.rms_m), fmt::format("{:.4f}", b.rms_m),
                            fmt::format("{:.2f}", a.rms_m > 0 ? b.rms_m / a.rms_m : 0),
                            fmt::format("{:.1f}", 100 * a.success), fmt::format("{:.1f}", 100 * d.success),
                            fmt::format("{:.1f}", 100 * b.success), fmt::format("{:.1f}", 100 * c.success),
                            fmt::format("{:.2f}", em->correspondences.value_or(1))});
    }
  return table;
}

std::vector<Table> all_tables(const Outcome& outcome) {
  return {scenes_table(outcome),         success_table(outcome), errors_table(outcome),
          success_errors_table(outcome), times_table(outcome),   entropies_table(outcome),
          edges_table(outcome),          overlap_table(outcome), rms_table(outcome)};
}

}  // namespace cairn::protocol
