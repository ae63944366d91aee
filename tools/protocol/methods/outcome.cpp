// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/methods/outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <tuple>

#include "onboard/report/figures/map_measures.hpp"
#include "tools/protocol/pairs/merged_pair.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

struct Titled {
  std::string_view name, title;
};
constexpr std::array kTitles{Titled{"icp", "ICP (PCL)"},
                             Titled{"p2plane", "point-to-plane ICP (PCL)"},
                             Titled{"gicp", "GICP (PCL)"},
                             Titled{"ndt", "NDT (PCL)"},
                             Titled{"oicp", "OICP"},
                             Titled{"edge_icp", "edge ICP"},
                             Titled{"pmm_level1", "PMM level 1"},
                             Titled{"pmm", "PMM"},
                             Titled{"em_book", "EM as printed"},
                             Titled{"em", "Cairn's EM"},
                             Titled{"default", "Cairn's default"}};

Result<FusedEntropy> fused_entropy(const MapPair& pair, std::string name, merging::Policy policy, const SE3& T_a_b) {
  const auto fused = merged_pair(pair, T_a_b, policy);
  if (!fused) return fused.error();
  const report::MapSummary summary = report::summarise(**fused);
  return FusedEntropy{std::move(name), summary.mean_entropy_occupancy.value_or(0),
                      summary.mean_entropy_book.value_or(0), summary.occupied};
}

Result<void> add_runs(const fs::path& file, std::vector<MethodRun>& runs) {
  if (!fs::exists(file)) return {};
  auto more = load_runs(file);
  if (!more) return more.error();
  std::move(more->begin(), more->end(), std::back_inserter(runs));
  return {};
}

Result<PairOutcome> load_pair_outcome(const fs::path& dir) {
  auto outcome = load_pair_with_runs(dir);
  if (!outcome) return outcome.error();
  if (outcome->pair.kind == kScene) {
    auto entropies = fused_entropies(outcome->pair, outcome->run("icp"));
    if (!entropies) return entropies.error();
    outcome->entropies = *std::move(entropies);
  }
  outcome->pair.a.reset();
  outcome->pair.b.reset();
  return outcome;
}

/// The voxels of both maps, none of them fused: as the book's "directly stitch" grows the map.
FusedEntropy side_by_side(const MapPair& pair) {
  const report::MapSummary a = report::summarise(*pair.a), b = report::summarise(*pair.b);
  const auto n_a = static_cast<double>(a.occupied), n_b = static_cast<double>(b.occupied);
  const auto mean = [&](const std::optional<double>& of_a, const std::optional<double>& of_b) {
    return (n_a * of_a.value_or(0) + n_b * of_b.value_or(0)) / std::max(1.0, n_a + n_b);
  };
  return {"side_by_side", mean(a.mean_entropy_occupancy, b.mean_entropy_occupancy),
          mean(a.mean_entropy_book, b.mean_entropy_book), a.occupied + b.occupied};
}

}  // namespace

const MethodRun* PairOutcome::run(std::string_view method) const {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const MethodRun& r) { return r.method == method; });
  return found == runs.end() ? nullptr : &*found;
}

const FusedEntropy* PairOutcome::entropy(std::string_view policy) const {
  const auto found =
      std::find_if(entropies.begin(), entropies.end(), [&](const FusedEntropy& e) { return e.policy == policy; });
  return found == entropies.end() ? nullptr : &*found;
}

std::vector<const PairOutcome*> Outcome::of_kind(std::string_view kind) const {
  std::vector<const PairOutcome*> chosen;
  for (const PairOutcome& p : pairs)
    if (p.pair.kind == kind) chosen.push_back(&p);
  return chosen;
}

std::vector<const PairOutcome*> Outcome::by_falling_overlap() const {
  auto cut = of_kind(kOverlap);
  std::stable_sort(cut.begin(), cut.end(), [](const PairOutcome* a, const PairOutcome* b) {
    return std::tie(a->pair.scene, b->pair.overlap) < std::tie(b->pair.scene, a->pair.overlap);
  });
  return cut;
}

std::string Outcome::starts_told(std::string_view kind) const {
  std::map<std::size_t, std::vector<std::string_view>, std::greater<>> methods;
  const auto chosen = of_kind(kind);
  for (const std::string_view method : table_methods())
    for (const PairOutcome* p : chosen)
      if (const MethodRun* run = p->run(method)) {
        methods[run->attempts.size()].push_back(title_of(method));
        break;
      }
  std::string told;
  for (const auto& [starts, titles] : methods)
    told += told.empty() ? fmt::format("From {} starts", starts)
                         : fmt::format("; from {}: {}", starts, fmt::join(titles, ", "));
  return told.empty() ? told : told + ". ";
}

std::span<const std::string_view> table_methods() {
  static const auto names = [] {
    std::array<std::string_view, kTitles.size()> all;
    std::transform(kTitles.begin(), kTitles.end(), all.begin(), [](const Titled& t) { return t.name; });
    return all;
  }();
  return names;
}

std::string_view title_of(std::string_view method) {
  for (const Titled& t : kTitles)
    if (t.name == method) return t.title;
  return method;
}

Result<std::vector<FusedEntropy>> fused_entropies(const MapPair& pair, const MethodRun* icp) {
  std::vector<FusedEntropy> all{side_by_side(pair)};
  const auto add = [&](std::string name, merging::Policy policy, const SE3& T_a_b) -> Result<void> {
    auto entropy = fused_entropy(pair, std::move(name), policy, T_a_b);
    if (!entropy) return entropy.error();
    all.push_back(*std::move(entropy));
    return {};
  };
  for (const std::string_view name : merging::policy_names())
    if (auto added = add(std::string(name), *merging::policy_from(name), pair.T_a_b); !added) return added.error();
  if (icp == nullptr) return all;
  const auto exact =
      std::find_if(icp->attempts.begin(), icp->attempts.end(), [](const Attempt& a) { return a.start == kExactStart; });
  if (exact != icp->attempts.end())
    if (auto added = add("jessup", merging::Policy::kAverage, exact->T_a_b); !added) return added.error();
  return all;
}

Result<PairOutcome> load_pair_with_runs(const fs::path& dir) {
  auto pair = load_pair(dir);
  if (!pair) return pair.error();
  PairOutcome outcome{*std::move(pair), {}, {}};
  for (const char* file : {"pcl.json", "ours.json"})
    if (auto added = add_runs(dir / file, outcome.runs); !added) return added.error();
  return outcome;
}

Result<Outcome> load_outcome(const fs::path& pairs, unsigned seed) {
  std::vector<fs::path> folders;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(pairs, code))
    if (fs::exists(entry.path() / "pair.json")) folders.push_back(entry.path());
  if (code) return Error{Errc::kIo, "cannot read the folder", pairs.string(), {}, code.message()};
  std::sort(folders.begin(), folders.end());
  Outcome outcome;
  outcome.seed = seed;
  for (const fs::path& dir : folders) {
    auto pair = load_pair_outcome(dir);
    if (!pair) return pair.error();
    outcome.pairs.push_back(*std::move(pair));
  }
  return outcome;
}

}  // namespace cairn::protocol
