// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/report.hpp"

#include <iostream>

#include "hal/files/file.hpp"
#include "tools/protocol/report/claims.hpp"
#include "tools/protocol/report/figures.hpp"
#include "tools/protocol/report/page_parts.hpp"
#include "tools/protocol/report/tables.hpp"

namespace cairn::protocol {
namespace {

Json to_json(const MethodRun& run) {
  const Figures f = figures_of(run.attempts);
  Json json = {{"method", run.method},
               {"success", f.success},
               {"mean_error_m", f.mean_error_m},
               {"mean_error_deg", f.mean_error_deg},
               {"seconds", f.seconds},
               {"iterations", f.iterations},
               {"starts", f.starts},
               {"median_error_m", f.median_error_m},
               {"median_error_deg", f.median_error_deg},
               {"success_error_m", f.success_error_m},
               {"success_error_deg", f.success_error_deg},
               {"slowest_s", f.slowest_s},
               {"preparation_s", run.preparation_s},
               {"accepted", f.accepted},
               {"wrongly_accepted", f.wrongly_accepted}};
  if (f.rms_m > 0) json["rms_m"] = f.rms_m;
  if (run.correspondences) json["correspondences"] = *run.correspondences;
  return json;
}

Json to_json(const PairOutcome& outcome) {
  const MapPair& p = outcome.pair;
  Json json = {{"name", p.name},       {"voxels_a", p.voxels_a}, {"voxels_b", p.voxels_b},  {"overlap", p.overlap},
               {"edges_a", p.edges_a}, {"edges_b", p.edges_b},   {"methods", Json::array()}};
  for (const std::string_view method : table_methods())
    if (const MethodRun* run = outcome.run(method)) json["methods"].push_back(to_json(*run));
  for (const FusedEntropy& e : outcome.entropies)
    json["fused"].push_back({{"policy", e.policy},
                             {"mean_entropy_occupancy", e.binary},
                             {"mean_entropy_book", e.book},
                             {"occupied", e.voxels}});
  return json;
}

}  // namespace

Json to_json(const Outcome& outcome) {
  Json json = {{"seed", outcome.seed}};
  struct Part {
    const char *name, *kind;
  };
  for (const Part& part : {Part{"scenes", kScene}, Part{"overlaps", kOverlap}, Part{"heterogeneous", kHeterogeneous}}) {
    json[part.name] = Json::array();
    for (const PairOutcome* p : outcome.of_kind(part.kind)) json[part.name].push_back(to_json(*p));
  }
  json["claims"] = Json::array();
  for (const Claim& c : claims_of(outcome))
    json["claims"].push_back(
        {{"claim", c.claim}, {"of", c.books ? "book" : "Cairn"}, {"figures", c.figures}, {"holds", c.holds}});
  return json;
}

Result<void> write_report(const std::filesystem::path& pairs, unsigned seed, const std::filesystem::path& out) {
  const auto outcome = load_outcome(pairs, seed);
  if (!outcome) return outcome.error();
  for (const Table& table : all_tables(*outcome)) std::cout << to_text(table);
  std::cout << to_text(claims_of(*outcome));
  if (auto written = write_file_atomic(out / "protocol.json", to_json(*outcome).dump(1) + '\n'); !written)
    return written;
  return write_file_atomic(out / "protocol.html", to_page(*outcome));
}

}  // namespace cairn::protocol
