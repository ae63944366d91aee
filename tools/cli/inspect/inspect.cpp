// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/inspect.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "drivers/camera/npy.hpp"
#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/stamp_guard.hpp"
#include "drivers/thermal/models.hpp"
#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"
#include "hal/files/file.hpp"
#include "hal/files/input_file.hpp"
#include "hal/files/unfinished_folder.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "tools/cli/inspect/calibration.hpp"
#include "tools/cli/inspect/captured_sensor.hpp"
#include "tools/cli/inspect/content.hpp"
#include "tools/cli/inspect/data_file.hpp"
#include "tools/cli/inspect/folder.hpp"
#include "tools/cli/inspect/inspect_stream.hpp"
#include "tools/cli/inspect/native_file.hpp"
#include "tools/cli/inspect/trajectory.hpp"
#include "tools/cli/label/recorded_answers.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using recording::Recording;
using recording::SourceEntry;

Result<report::Json> write_scan(const InspectOptions& options, const std::optional<Scan>& scan, std::uint64_t scans) {
  if (!scan)
    return Error{Errc::kNotFound, "there is no such scan", options.path.string(), {}, std::to_string(scans) + " scans"};
  if (auto written = write_file_atomic(options.out, recording::to_pcd(scan->cloud)); !written) return written.error();
  return report::Json{{"file", options.out.string()},
                      {"points", scan->cloud.size()},
                      {"start_s", to_seconds(scan->valid.start)},
                      {"end_s", to_seconds(scan->valid.end)},
                      {"incomplete", scan->incomplete}};
}

/// Of a file that holds one scan.
Result<report::Json> write_only_scan(const InspectOptions& options, PointCloud cloud) {
  if (options.scan.value_or(0) > 0) return write_scan(options, std::nullopt, 1);
  Scan scan;
  scan.cloud = std::move(cloud);
  return write_scan(options, scan, 1);
}

/// Appends what the stream holds to what is known of it.
Result<report::Json> inspect_stream(const InspectOptions& options, const Recording& recording, Source& source,
                                    report::Json json) {
  auto inspection = StreamInspection::create(recording, options.scan);
  if (!inspection) return inspection.error();
  (*inspection)->run(source);
  json["sources"] = (*inspection)->sources();
  json["events"] = (*inspection)->events();
  json["damaged"] = (*inspection)->damaged();
  json["damage"] = (*inspection)->damage();
  if (options.out.empty()) return json;
  auto written = write_scan(options, (*inspection)->kept(), (*inspection)->scans());
  if (!written) return written.error();
  json["out"] = std::move(*written);
  return json;
}

void add_damage(const std::vector<std::string>& damage, report::Json& json) {
  constexpr std::size_t kMostNamed = 16;
  json["damaged"] = json["damaged"].get<std::uint64_t>() + damage.size();
  for (std::size_t i = 0; i < std::min(damage.size(), kMostNamed); ++i) json["damage"].push_back(damage[i]);
}

Result<report::Json> inspect_recording(const InspectOptions& options) {
  auto reader = recording::RecordingReader::open(options.path);
  if (!reader) return reader.error();
  Recording recording = (*reader)->recording();
  if (!options.model.empty())
    for (SourceEntry& s : recording.sources) s.model = options.model;
  report::Json json{{"kind", "recording"},
                    {"path", options.path.string()},
                    {"robot", recording.robot},
                    {"profile", recording.profile},
                    {"start_utc", recording::to_iso_utc(recording.start_utc_ns)},
                    {"realtime_offset_ns", recording.realtime_offset_ns},
                    {"unfinished", recording.unfinished},
                    {"notes", recording.notes}};
  std::error_code ignored;
  const fs::path truth = options.path / "ground_truth.tum";
  json["ground_truth"] = fs::exists(truth, ignored) ? describe_trajectory(truth) : report::Json(nullptr);
  auto found = inspect_stream(options, recording, **reader, std::move(json));
  if (!found) return found;
  std::vector<std::string> damage;
  (*found)["labels"] = describe_labels(options.path, damage);
  (*found)["boxes"] = describe_boxes(options.path, damage);
  if (recording.unfinished && options.unfinished_is_damage)
    damage.push_back(to_string(recording::unfinished_recording(options.path)));
  add_damage(damage, *found);
  return found;
}

Result<report::Json> inspect_capture(const InspectOptions& options) {
  auto first_look = velodyne::PcapSource::open(options.path, {});
  if (!first_look) return first_look.error();
  Recording recording;
  SourceEntry entry = captured_sensor(**first_look);
  entry.file = options.path.filename().string();
  if (!options.model.empty()) entry.model = options.model;
  if (entry.model.empty())
    return Error{Errc::kUnsupported,
                 "no known Velodyne sensor in the capture",
                 options.path.string(),
                 {},
                 "name it with --model: " + velodyne::model_names()};
  recording.sources.push_back(entry);
  auto opened = velodyne::PcapSource::open(options.path, {});
  if (!opened) return opened.error();
  const velodyne::PcapSource& capture = **opened;
  recording::GuardedSource guarded(std::move(*opened), options.path.string(),
                                   [&capture] { return capture.record_offset(); });
  auto json = inspect_stream(options, recording, guarded, {{"kind", "capture"}, {"path", options.path.string()}});
  if (!json) return json;
  const auto& c = capture.counters();
  (*json)["records"] = {{"whole", c.records},
                        {"not_udp", c.foreign},
                        {"malformed", c.malformed},
                        {"cut_short", c.truncated},
                        {"ends_inside_a_record", c.truncated_tail}};
  return json;
}

Result<report::Json> inspect_cloud(const InspectOptions& options) {
  const auto bytes = read_file(options.path, recording::kMaxPcdBytes);
  if (!bytes) return bytes.error();
  const auto header = recording::parse_pcd_header(*bytes, options.path.string());
  if (!header) return header.error();
  const auto pcd = recording::parse_pcd(*bytes, options.path.string());
  if (!pcd) return pcd.error();
  report::Json json{{"kind", "point cloud"},
                    {"path", options.path.string()},
                    {"points", pcd->cloud.size()},
                    {"rejected", pcd->rejected}};
  for (const auto& f : header->fields) json["fields"].push_back(f.name);
  json["has_time"] = pcd->has_time;
  if (options.out.empty()) return json;
  auto written = write_only_scan(options, pcd->cloud);
  if (!written) return written.error();
  json["out"] = std::move(*written);
  return json;
}

Result<report::Json> inspect_map(const InspectOptions& options) {
  const auto map = mapping::load_map(options.path);
  if (!map) return at(options.path.string(), map.error());
  report::Json json{{"kind", "map"}, {"path", options.path.string()}};
  json.update(report::to_json(report::summarise(**map)));
  return json;
}

Error not_known(const fs::path& path) {
  return {Errc::kUnsupported,
          "what this file holds is not known",
          path.string(),
          {},
          "known: folders of recordings and runs, pcap, pcapng, candump, gpio.csv, lists of pictures, pictures, sweeps "
          "(.bin), .npy, .pcd, .cairn, .ot, .bt, .tum, calibrations (.yaml, .yml)"};
}

Result<report::Json> inspect_native_file(const InspectOptions& options) {
  auto recognised = recognise_native_file(options.path);
  if (!recognised) return not_known(options.path);
  NativeFile& file = *recognised;
  SourceEntry& entry = file.recording.sources.front();
  if (!options.model.empty()) entry.model = options.model;
  auto source = recording::open_recorded_source(file.dir, file.recording, 0);
  if (!source) return source.error();
  return inspect_stream(options, file.recording, **source,
                        {{"kind", to_string(entry.kind)}, {"path", options.path.string()}});
}

/// By the size of its pictures, with or without telemetry rows.
std::string thermal_model(const camera::NpyHeader& header) {
  for (const thermal::Model& m : thermal::models())
    if (m.width == header.width && (m.height == header.height || m.height + m.rows == header.height))
      return std::string(m.name);
  return "plain";
}

Result<report::Json> inspect_other_numbers(const InspectOptions& options) {
  if (const auto used = check_options(options, Content::kNumbers); !used) return used.error();
  return inspect_numbers(options.path);
}

/// The file knows neither times nor the sensor. Two bytes a pixel are temperatures, or depth where a name says so.
Result<report::Json> inspect_array(const InspectOptions& options) {
  camera::NpySource::Options as;
  const bool depth = says_depth(options.path);
  if (depth) as.deep = camera::FrameFormat::kZ16;
  auto source = camera::NpySource::open(options.path, as);
  if (!source && source.error().code == Errc::kUnsupported) return inspect_other_numbers(options);
  if (!source) return source.error();
  const camera::NpyHeader& header = (*source)->header();
  const bool grey = header.pixel_bytes == 1;
  const recording::SensorKind kind = grey ? recording::kCamera : depth ? recording::kDepth : recording::kThermal;
  SourceEntry entry{
      .id = "source", .kind = kind, .file = options.path.filename().string(), .frame = "", .model = options.model};
  if (entry.model.empty() && kind == recording::kThermal) entry.model = thermal_model(header);
  Recording recording;
  recording.sources.push_back(std::move(entry));
  return inspect_stream(options, recording, **source,
                        {{"kind", to_string(kind)}, {"path", options.path.string()}, {"assumed_rate_hz", as.rate_hz}});
}

Result<report::Json> inspect_bin(const InspectOptions& options) {
  auto sweep = inspect_sweep(options.path);
  if (!sweep) return sweep.error();
  if (options.out.empty()) return std::move(sweep->json);
  auto written = write_only_scan(options, std::move(sweep->cloud));
  if (!written) return written.error();
  sweep->json["out"] = std::move(*written);
  return std::move(sweep->json);
}

/// A file of any text may be called .txt: it is a trajectory if it has a pose.
Result<report::Json> inspect_trajectory(const fs::path& path) {
  report::Json json{{"kind", "trajectory"}, {"path", path.string()}};
  json.update(describe_trajectory(path));
  if (path.extension() != ".tum" && json["poses"] == 0) return not_known(path);
  return json;
}

Result<report::Json> inspect_content(const InspectOptions& options, Content content) {
  switch (content) {
    case Content::kRecording:
      return inspect_recording(options);
    case Content::kRun:
      return inspect_run(options.path);
    case Content::kFolder:
      return inspect_parent(options.path);
    case Content::kCapture:
      return inspect_capture(options);
    case Content::kPicture:
      return inspect_picture(options.path);
    case Content::kNativeFile:
      return inspect_native_file(options);
    case Content::kCloud:
      return inspect_cloud(options);
    case Content::kPictures:
      return inspect_array(options);
    case Content::kSweep:
      return inspect_bin(options);
    case Content::kMap:
      return inspect_map(options);
    case Content::kTrajectory:
      return inspect_trajectory(options.path);
    case Content::kCalibration:
      return inspect_calibration(options.path, options.out, options.as, options.camera.value_or(0));
    case Content::kNumbers:  // which the header of an array says
    case Content::kUnknown:
      break;
  }
  return not_known(options.path);
}

}  // namespace

Result<report::Json> inspect(const InspectOptions& options) {
  std::error_code error;
  const bool folder = fs::is_directory(options.path, error);
  if (!options.out.empty() && (!folder || fs::exists(options.out, error)))  // a new file in the folder harms nothing
    if (const auto kept = keep_input(options.path, options.out); !kept) return kept.error();
  const auto content = content_of(options.path);
  if (!content) return content.error();
  if (const auto used = check_options(options, *content); !used) return used.error();
  if (!options.out.empty() && *content != Content::kCalibration && options.out.extension() != ".pcd")
    return Error{Errc::kInvalidConfig, "the name must end in .pcd", "--out " + options.out.string(), {}, {}};
  return inspect_content(options, *content);
}

}  // namespace cairn::cli
