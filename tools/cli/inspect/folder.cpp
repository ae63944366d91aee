// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/folder.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "tools/cli/inspect/trajectory.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using report::Json;

constexpr const char* kReport = "report.json";
constexpr std::size_t kMostListed = 1000;  // entries of a folder that are looked at

/// Sorted by name.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && entries.size() < kMostListed;
       at.increment(error))
    entries.push_back(at->path());
  std::ranges::sort(entries);
  return entries;
}

Result<Json> read_report(const fs::path& file) {
  constexpr std::uint64_t kMost = std::uint64_t{64} << 20U;
  const auto bytes = read_file(file, kMost);
  if (!bytes) return bytes.error();
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  Json json = Json::parse(text, text + bytes->size(), nullptr, false);
  if (!json.is_object()) return Error{Errc::kMalformed, "not the report of a run", file.string()};
  return json;
}

Json describe_map(const fs::path& file) {
  const auto map = mapping::load_map(file);
  if (!map) return {{"damage", to_string(at(file.string(), map.error()))}};
  const report::MapSummary summary = report::summarise(**map);
  return {{"resolution_m", summary.resolution_m}, {"occupied", summary.occupied}, {"free", summary.free}};
}

Json sizes_of(const fs::path& folder) {
  Json sizes = Json::object();
  for (const fs::path& entry : entries_of(folder)) {
    std::error_code error;
    if (fs::is_regular_file(entry, error)) sizes[entry.filename().string()] = fs::file_size(entry, error);
  }
  return sizes;
}

/// From the index alone: nothing is decoded.
Json describe_recording(const fs::path& folder) {
  Json json{{"path", folder.string()}};
  const auto recording = recording::load_recording(folder);
  if (!recording) {
    json["damage"] = to_string(recording.error());
    return json;
  }
  json["robot"] = recording->robot;
  json["start_utc"] = recording::to_iso_utc(recording->start_utc_ns);
  std::string sources;
  for (const recording::SourceEntry& source : recording->sources)
    sources += (sources.empty() ? "" : ", ") + source.id + " (" + std::string(to_string(source.kind)) + ")";
  json["sources"] = sources;
  std::error_code ignored;
  json["ground_truth"] = fs::exists(folder / "ground_truth.tum", ignored);
  return json;
}

/// ".bin 16, folders 2": what a folder holds that has nothing else to say.
std::string kinds_of(const std::vector<fs::path>& entries) {
  std::map<std::string, std::size_t> counts;
  for (const fs::path& entry : entries) {
    std::error_code error;
    const std::string extension = entry.extension().string();
    ++counts[fs::is_directory(entry, error) ? "folders" : extension.empty() ? "files without extension" : extension];
  }
  std::string text;
  for (const auto& [kind, n] : counts) text += (text.empty() ? "" : ", ") + kind + " " + std::to_string(n);
  return text.empty() ? "it is empty" : "it holds: " + text;
}

}  // namespace

bool is_run(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kReport, error);
}

Json inspect_run(const fs::path& folder) {
  Json json{{"kind", "run"}, {"path", folder.string()}};
  const auto report = read_report(folder / kReport);
  if (report)
    for (const char* key : {"robot", "profile", "source", "version", "started", "duration_s", "distance_m", "scans",
                            "lost_packets", "mode", "notes", "output_sha256"})
      json[key] = report->value(key, Json());
  else
    json["damage"] = to_string(report.error());
  json["trajectory"] = describe_trajectory(folder / "trajectory.tum");
  json["map"] = describe_map(folder / "map.cairn");
  json["bytes"] = sizes_of(folder);
  return json;
}

Result<Json> inspect_parent(const fs::path& folder) {
  Json recordings = Json::array(), runs = Json::array();
  const std::vector<fs::path> entries = entries_of(folder);
  for (const fs::path& entry : entries) {
    std::error_code error;
    if (fs::exists(entry / recording::kIndexFile, error)) recordings.push_back(describe_recording(entry));
    if (is_run(entry)) runs.push_back(entry.string());
  }
  if (recordings.empty() && runs.empty())
    return Error{Errc::kUnsupported,
                 "no recording.yaml and no report.json, neither here nor one folder below",
                 folder.string(),
                 {},
                 kinds_of(entries)};
  return Json{{"kind", "folder"}, {"path", folder.string()}, {"recordings", recordings}, {"runs", runs}};
}

}  // namespace cairn::cli
