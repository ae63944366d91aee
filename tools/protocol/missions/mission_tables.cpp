// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tools/protocol/missions/mission_report.hpp"
#include "tools/protocol/pairs/book.hpp"

namespace cairn::protocol {
namespace {

constexpr double kMega = 1e-6;
constexpr std::size_t kJessup = 0, kOurs = 2;         // of kApproaches
constexpr double kMostMapMb = 30, kMostStatesMb = 1;  // the book's Fig. 6.11

/// Calls with light, phase and the phase's index.
template <class Visit>
void for_each_time(const Visit& visit) {
  for (const char* light : kLights)
    for (std::size_t i = 0; i < kPhases.size(); ++i) visit(light, kPhases.at(i), i);
}

std::string rms_text(const MissionOutcome* outcome) {
  return outcome != nullptr && outcome->run ? fmt::format("{:.4f}", outcome->rms_m()) : "–";
}

std::string success_text(const MissionOutcome* outcome) {
  return outcome != nullptr && outcome->run ? fmt::format("{:.0f}", 100 * outcome->success()) : "–";
}

std::string book_text(std::string_view light, std::size_t phase) {
  for (const BookPeopleRms& book : kBookPeopleRms)
    if (book.light == light) return fmt::format("({:.4f} / {:.4f})", book.jessup.at(phase), book.ours.at(phase));
  return "–";
}

void add_rms_claim(const std::vector<MissionOutcome>& all, std::vector<Claim>& claims) {
  for_each_time([&](const char* light, const char* phase, std::size_t) {
    const MissionOutcome *jessup = find(all, light, phase, kJessup), *ours = find(all, light, phase, kOurs);
    if (jessup == nullptr || ours == nullptr || !jessup->run || !ours->run) return;
    claims.push_back({fmt::format("{}, {}: RMS of matched voxels at or below Jessup's", light, phase),
                      fmt::format("{:.4f} against {:.4f} m", ours->rms_m(), jessup->rms_m()),
                      ours->rms_m() <= jessup->rms_m()});
  });
}

}  // namespace

Table people_rms_table(const std::vector<MissionOutcome>& all) {
  Table table{"RMS of matched voxels of two robots among people, m (book: Table 6.2)",
              "Voxels with a partner within 1 m, mean over the starts. The book's numbers (Jessup / its own) are from "
              "another forest.",
              {"", "Jessup", "day only", "Cairn", "(book)", "success Jessup, %", "day only", "Cairn"},
              {}};
  for_each_time([&](const char* light, const char* phase, std::size_t i) {
    std::vector<std::string> row{fmt::format("{}, {}", light, phase)};
    for (std::size_t k = 0; k < kApproaches.size(); ++k) row.push_back(rms_text(find(all, light, phase, k)));
    row.push_back(book_text(light, i));
    for (std::size_t k = 0; k < kApproaches.size(); ++k) row.push_back(success_text(find(all, light, phase, k)));
    table.rows.push_back(std::move(row));
  });
  return table;
}

Table merged_table(const std::vector<MissionOutcome>& all) {
  Table table{"The merged map against the empty scene: voxels where nothing stands / RMS, m",
              fmt::format("A voxel where nothing stands is farther than {} m from the true map. Distances over 1 m "
                          "count as 1 m. Errors of odometry are in it.",
                          MergedFigures::kGhostM),
              {"", "Jessup", "day only", "Cairn"},
              {}};
  for_each_time([&](const char* light, const char* phase, std::size_t) {
    std::vector<std::string> row{fmt::format("{}, {}", light, phase)};
    for (std::size_t k = 0; k < kApproaches.size(); ++k) {
      const MissionOutcome* o = find(all, light, phase, k);
      row.push_back(o != nullptr && o->merged
                        ? fmt::format("{} of {} / {:.4f}", o->merged->ghosts, o->merged->occupied, o->merged->rms_m)
                        : "–");
    }
    table.rows.push_back(std::move(row));
  });
  return table;
}

Table bytes_table(const std::vector<MissionOutcome>& all) {
  Table table{"Data of a robot since the mission began, MB (book: Fig. 6.11)",
              "Raw: packets of the LiDAR and PNG pictures. Map: map.cairn. States: messages about people to one "
              "teammate, with all overhead. Of two robots the one that has more.",
              {"", "seconds", "raw", "map", "states of people"},
              {}};
  for_each_time([&](const char* light, const char* phase, std::size_t) {
    const MissionOutcome* o = find(all, light, phase, kOurs);
    if (o == nullptr) return;
    const Mission& m = o->mission;
    table.rows.push_back({fmt::format("{}, {}", light, phase), fmt::format("{:.0f}", m.seconds),
                          fmt::format("{:.1f}", kMega * static_cast<double>(m.raw_bytes)),
                          fmt::format("{:.3f}", kMega * static_cast<double>(m.map_bytes)),
                          fmt::format("{:.4f}", kMega * static_cast<double>(m.states_bytes))});
  });
  return table;
}

std::vector<Claim> mission_claims(const std::vector<MissionOutcome>& all) {
  std::vector<Claim> claims;
  add_rms_claim(all, claims);
  for (const char* light : kLights) {
    const MissionOutcome* o = find(all, light, kPhases.back(), kOurs);
    if (o == nullptr) continue;
    const double map = kMega * static_cast<double>(o->mission.map_bytes),
                 states = kMega * static_cast<double>(o->mission.states_bytes);
    claims.push_back({fmt::format("{}: a map of less than {} MB and states of people of less than {} MB", light,
                                  kMostMapMb, kMostStatesMb),
                      fmt::format("{:.3f} and {:.4f} MB", map, states), map < kMostMapMb && states < kMostStatesMb});
  }
  return claims;
}

}  // namespace cairn::protocol
