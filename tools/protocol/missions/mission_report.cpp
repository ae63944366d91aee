// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/mission_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "hal/files/file.hpp"
#include "tools/protocol/report/page_parts.hpp"
#include "tools/protocol/report/plot.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPictureBytes = 32U << 20U;  // a bound on memory

/// y of each outcome by seconds, of one approach by one light.
template <class Value>
Line line_of(const std::vector<MissionOutcome>& all, std::string_view light, std::size_t approach, std::string name,
             std::size_t colour, const Value& value) {
  Line line{std::move(name), colour, {}, {}};
  for (const MissionOutcome& o : all) {
    if (o.mission.light != light || o.approach != approach) continue;
    line.x.push_back(o.mission.seconds);
    line.y.push_back(value(o));
  }
  return line;
}

constexpr std::array<std::size_t, kApproaches.size()> kColours{2, 1, 9};  // of the page's palette

std::string rms_curves(const std::vector<MissionOutcome>& all) {
  std::string figures;
  std::vector<Line> lines;
  double most = 0, last = 0;
  for (const MissionOutcome& o : all) most = std::max(most, o.rms_m()), last = std::max(last, o.mission.seconds);
  for (const char* light : kLights) {
    lines.clear();
    for (std::size_t k = 0; k < kApproaches.size(); ++k)
      lines.push_back(line_of(all, light, k, std::string(kApproaches.at(k).title), kColours.at(k),
                              [](const MissionOutcome& o) { return o.rms_m(); }));
    figures += figure(light, line_plot({"s", 0, last, false}, {"m", 0, most, false}, lines.front().x, lines));
  }
  return charts_section("RMS of matched voxels", figures, legend(lines));
}

std::string bytes_curves(const std::vector<MissionOutcome>& all) {
  constexpr std::size_t kOurs = kApproaches.size() - 1;
  constexpr double kMega = 1e-6, kLeast = 0.001, kMost = 10'000;
  std::string figures;
  std::vector<Line> lines;
  for (const char* light : kLights) {
    const auto curve = [&](const char* name, std::size_t colour, std::uint64_t Mission::*bytes) {
      return line_of(all, light, kOurs, name, colour,
                     [&](const MissionOutcome& o) { return kMega * static_cast<double>(o.mission.*bytes); });
    };
    lines = {curve("raw", 0, &Mission::raw_bytes), curve("map", 9, &Mission::map_bytes),
             curve("states of people", 4, &Mission::states_bytes)};
    const double last = lines.front().x.empty() ? 1 : lines.front().x.back();
    figures += figure(light, line_plot({"s", 0, last, false}, {"MB", kLeast, kMost, true}, lines.front().x, lines));
  }
  return charts_section("Data of a robot (book: Fig. 6.11)", figures, legend(lines));
}

std::string pictures_section(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::ranges::sort(files);
  std::string figures;
  for (const fs::path& file : files)
    if (const auto png = read_file(file, kMaxPictureBytes)) figures += picture(file.stem().string(), *png);
  return figures.empty() ? figures : charts_section("What the robots see (book: Fig. 6.7 to 6.10)", figures);
}

Json to_json(const MissionOutcome& o) {
  const Mission& m = o.mission;
  Json json = {{"light", m.light},
               {"phase", m.phase},
               {"approach", kApproaches.at(o.approach).title},
               {"seconds", m.seconds},
               {"rms_m", o.run ? Json(o.rms_m()) : Json(nullptr)},
               {"success", o.run ? Json(o.success()) : Json(nullptr)},
               {"raw_bytes", m.raw_bytes},
               {"map_bytes", m.map_bytes},
               {"states_bytes", m.states_bytes}};
  json["occupied"] = o.merged ? Json(o.merged->occupied) : Json(nullptr);
  json["ghosts"] = o.merged ? Json(o.merged->ghosts) : Json(nullptr);
  json["world_rms_m"] = o.merged ? Json(o.merged->rms_m) : Json(nullptr);
  return json;
}

}  // namespace

Json missions_json(const std::vector<MissionOutcome>& all, unsigned seed) {
  Json json = {{"seed", seed}, {"missions", Json::array()}, {"claims", Json::array()}};
  for (const MissionOutcome& o : all) json["missions"].push_back(to_json(o));
  for (const Claim& c : mission_claims(all))
    json["claims"].push_back({{"claim", c.claim}, {"figures", c.figures}, {"holds", c.holds}});
  return json;
}

std::string missions_page(const std::vector<MissionOutcome>& all, unsigned seed, const fs::path& pictures) {
  std::string page = page_head(
      "Mapping among people: the protocol", "Mapping among people, by day and by night",
      fmt::format("Yue &amp; Wang, Collaborative Perception, Localization and Mapping for Autonomous Systems, "
                  "ch. 6; two robots in a simulated forest. Seed {}.",
                  seed));
  page +=
      claims_section("What is asked of Cairn", mission_claims(all)) + to_html(people_rms_table(all)) + rms_curves(all);
  page += to_html(merged_table(all)) + to_html(bytes_table(all)) + bytes_curves(all) + pictures_section(pictures);
  return page + page_end(
                    "Maps: Cairn's runs at 0.1 m, with its own odometry. ICP is PCL's: pairs within 2 m, at most 30 "
                    "iterations. Starts: x and y ±2 m, yaw ±15°, around the true pose.");
}

Result<void> write_missions(const fs::path& pairs, const fs::path& pictures, unsigned seed, const fs::path& out) {
  const auto all = load_missions(pairs);
  if (!all) return all.error();
  for (const Table& table : {people_rms_table(*all), merged_table(*all), bytes_table(*all)})
    std::cout << to_text(table);
  std::cout << to_text(mission_claims(*all));
  if (auto written = write_file_atomic(out / "people.json", missions_json(*all, seed).dump(1) + '\n'); !written)
    return written;
  return write_file_atomic(out / "people.html", missions_page(*all, seed, pictures));
}

}  // namespace cairn::protocol
