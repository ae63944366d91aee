// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <system_error>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"
#include "hal/files/input_file.hpp"
#include "hal/files/unfinished_folder.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "onboard/report/figures/trajectory_error.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/report/pictures/map_paint.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "tools/cli/map/costmap_command.hpp"
#include "tools/cli/map/map_check_command.hpp"
#include "tools/cli/map/map_pull_command.hpp"
#include "tools/cli/map/save_map.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct MapOptions {
  fs::path file, other, out, trajectory, ground_truth;
  std::string view = "top";
  std::optional<double> height_min_m, height_max_m;
  double pixels_per_m = 0;
  bool classes = false, json = false;
};

int wrong(const std::string& message) {
  std::cerr << "cairn: " << message << '\n';
  return app::kWrongArguments;
}

/// The content decides, not the name; load_map() has verified the checksums of such a file.
bool has_checksums(const fs::path& path) {
  std::array<char, 64> head{};
  auto file = InputFile::open(path);
  if (file) (void)file->read(std::as_writable_bytes(std::span(head)));
  return mapping::is_cairn(std::as_bytes(std::span(head)));
}

report::Json info_json(const MapOptions& options, const mapping::SemanticOcTree& map,
                       const report::MapSummary& summary) {
  std::error_code ignored;
  report::Json json = {{"file", options.file.string()},
                       {"file_bytes", fs::file_size(options.file, ignored)},
                       {"checksum", has_checksums(options.file) ? "ok" : "none"}};
  json.update(report::to_json(summary));
  json["sensor_model"] = {{"hit", map.getProbHit()},
                          {"miss", map.getProbMiss()},
                          {"clamping_min", map.getClampingThresMin()},
                          {"clamping_max", map.getClampingThresMax()},
                          {"occupancy_threshold", map.getOccupancyThres()}};
  return json;
}

std::string info_text(const report::Json& json, const report::MapSummary& summary) {
  const Eigen::Vector3d size = summary.max_m - summary.min_m;
  std::string text = fmt::format(
      "{}\n  resolution    {} m\n  occupied      {} voxels, {} labelled\n  free          {} voxels\n"
      "  known volume  {:.1f} m³ in a box of {:.1f} × {:.1f} × {:.1f} m from ({:.1f}, {:.1f}, {:.1f})\n"
      "  nodes         {}, {} of them leaves\n  size          {:.2f} MiB in memory, {:.2f} MiB in the file\n"
      "  checksum      {}\n",
      json["file"].get<std::string>(), summary.resolution_m, summary.occupied, summary.labelled, summary.free,
      summary.known_volume_m3(), size.x(), size.y(), size.z(), summary.min_m.x(), summary.min_m.y(), summary.min_m.z(),
      summary.nodes, summary.leaves, static_cast<double>(summary.memory_bytes) / 0x1p20,
      json["file_bytes"].get<double>() / 0x1p20, json["checksum"] == "ok" ? "correct" : "this format has none");
  for (std::size_t i = 0; i < report::kClasses; ++i)
    if (summary.by_class[i] > 0)
      text += fmt::format("    {:<13} {} voxels\n", kSemanticClasses[i].name, summary.by_class[i]);
  if (summary.mean_entropy_label)
    text += fmt::format("  label entropy {:.4f} bit over labelled voxels\n", *summary.mean_entropy_label);
  if (summary.mean_entropy_occupancy)
    text += fmt::format("  mean entropy  {:.4f} bit over occupied voxels ({:.4f} as −p log2 p), {:.4f} over all\n",
                        *summary.mean_entropy_occupancy, *summary.mean_entropy_book, *summary.mean_entropy_known);
  return text;
}

int info(const MapOptions& options) {
  const auto map = mapping::load_map(options.file);
  if (!map) return app::fail(at(options.file.string(), map.error()));
  const report::MapSummary summary = report::summarise(**map);
  const report::Json json = info_json(options, **map, summary);
  if (options.json) return app::print(json);
  std::cout << info_text(json, summary);
  return app::kDone;
}

int compare_maps(const MapOptions& options) {
  const auto a = mapping::load_map(options.file), b = mapping::load_map(options.other);
  if (!a) return app::fail(at(options.file.string(), a.error()));
  if (!b) return app::fail(at(options.other.string(), b.error()));
  const auto c = report::compare(**a, **b);
  if (!c) return app::fail(at(options.other.string(), c.error()));
  const report::MapSummary summary_a = report::summarise(**a), summary_b = report::summarise(**b);
  if (options.json) {
    report::Json json = report::to_json(*c);
    const auto add = [&](const char* name, const std::optional<double>& v) {
      json[name] = v ? report::Json(*v) : report::Json(nullptr);
    };
    add("mean_entropy_occupancy", summary_a.mean_entropy_occupancy);
    add("mean_entropy_occupancy_b", summary_b.mean_entropy_occupancy);
    add("mean_entropy_book", summary_a.mean_entropy_book);
    add("mean_entropy_book_b", summary_b.mean_entropy_book);
    add("mean_entropy_label", summary_a.mean_entropy_label);
    add("mean_entropy_label_b", summary_b.mean_entropy_label);
    return app::print(json);
  }
  std::cout << fmt::format(
      "same         {} voxels ({} of them with other log-odds)\ndisagreeing  {}\nonly a       {}\nonly b       {}\n"
      "occupied     {} in a, {} in b, {} in both\nfree         {} in a, {} in b\n",
      c->same, c->differing_log_odds < c->disagreeing ? 0 : c->differing_log_odds - c->disagreeing, c->disagreeing,
      c->only_a, c->only_b, c->occupied_a, c->occupied_b, c->occupied_both, c->free_a, c->free_b);
  if (const auto iou = c->iou_occupied()) std::cout << fmt::format("occupied IoU {:.4f}\n", *iou);
  if (const auto agreement = c->labels.agreement())
    std::cout << fmt::format("labels       {} voxels labelled in both, {:.4f} of them alike; mean IoU {:.4f}\n",
                             c->labels.total(), *agreement, c->labels.miou(0).value_or(0));
  return app::kDone;
}

report::MapPath projected(report::MapView view, const std::vector<recording::StampedPose>& poses, bool dashed) {
  report::MapPath path{{}, dashed};
  for (const recording::StampedPose& p : poses) path.points.push_back(report::project(view, p.pose.translation()));
  return path;
}

/// The trajectory and, under it, the ground truth in the trajectory's frame. Empty names are left out.
Result<std::vector<report::MapPath>> read_paths(const MapOptions& options, report::MapView view) {
  std::vector<report::MapPath> paths;
  std::vector<recording::StampedPose> trajectory, truth;
  if (!options.trajectory.empty()) {
    auto read = recording::read_tum(options.trajectory);
    if (!read) return at(options.trajectory.string(), read.error());
    trajectory = std::move(*read);
  }
  if (!options.ground_truth.empty()) {
    auto read = recording::read_tum(options.ground_truth);
    if (!read) return at(options.ground_truth.string(), read.error());
    truth = std::move(*read);
    if (!trajectory.empty())
      truth = report::truth_in_estimate_frame(trajectory, truth, report::TrajectoryErrorOptions{}.max_gap);
    paths.push_back(projected(view, truth, true));
  }
  if (!trajectory.empty()) paths.insert(paths.begin(), projected(view, trajectory, false));
  return paths;
}

int render(const MapOptions& options) {
  const auto view = report::map_view_from(options.view);
  if (!view) return wrong("--view " + options.view + ": choose top, side or front");
  if (options.out.extension() != ".png")
    return wrong("--out " + options.out.string() + ": the picture is a PNG, so the name must end in .png");
  if (const auto kept = keep_input(options.file, options.out); !kept) return app::fail(kept.error());
  const auto map = mapping::load_map(options.file);
  if (!map) return app::fail(at(options.file.string(), map.error()));
  const auto picture = report::look_at(**map, {*view, options.height_min_m, options.height_max_m});
  if (!picture) return app::fail(at(options.file.string(), picture.error()));
  auto paths = read_paths(options, *view);
  if (!paths) return app::fail(paths.error());
  if (options.classes && !picture->labelled())
    return app::fail({Errc::kNotFound,
                      "no voxel in this view has a label",
                      options.file.string(),
                      {},
                      "leave out --classes; `cairn map info` counts the labels"});
  const auto image = report::draw_map(*picture, {options.pixels_per_m, std::move(*paths), options.classes});
  if (!image) return app::fail(at(options.out.string(), image.error()));
  const auto png = report::encode_png(*image);
  if (!png) return app::fail(at(options.out.string(), png.error()));
  if (const auto written = write_file_atomic(options.out, *png); !written) return app::fail(written.error());
  report::Json json{{"out", options.out.string()}};
  json["width"] = image->width();
  json["height"] = image->height();
  json["pixels_per_m"] = report::pixels_per_metre(*picture, {options.pixels_per_m, {}, false});
  json["cut_above_m"] = picture->cut_m ? report::Json(*picture->cut_m) : report::Json(nullptr);
  if (options.json) return app::print(json);
  std::cout << fmt::format("{}: {} × {} pixels\n", options.out.string(), image->width(), image->height());
  if (picture->cut_m)
    std::cout << fmt::format("cut open at z = {:.2f} m, below a ceiling; --height-max shows it\n", *picture->cut_m);
  return app::kDone;
}

int export_map(const MapOptions& options) {
  if (const auto named = check_map_name(options.out); !named) return app::fail(named.error());
  if (const auto kept = keep_input(options.file, options.out); !kept) return app::fail(kept.error());
  const auto map = mapping::load_map(options.file);
  if (!map) return app::fail(at(options.file.string(), map.error()));
  if (const auto saved = save_map(**map, options.out); !saved) return app::fail(saved.error());
  std::error_code ignored;
  const auto bytes = fs::file_size(options.out, ignored);
  if (options.json) return app::print({{"out", options.out.string()}, {"bytes", bytes}});
  std::cout << fmt::format("{}: {} bytes\n", options.out.string(), bytes);
  return app::kDone;
}

CLI::App* add(app::Commands& commands, CLI::App& map, const std::string& name, const std::string& description,
              const std::shared_ptr<MapOptions>& options, int (*job)(const MapOptions&)) {
  CLI::App* sub = map.add_subcommand(name, description);
  sub->add_option("file", options->file, ".cairn, .ot or .bt")->required();
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options, job] { commands.job = [options, job] { return job(*options); }; });
  return sub;
}

}  // namespace

void add_map_command(app::Commands& commands) {
  CLI::App& map = *commands.app.add_subcommand(
      "map", "describes, compares, checks, draws and converts maps, and pulls that of a running core");
  map.require_subcommand(1);
  const auto options = std::make_shared<MapOptions>();
  add(commands, map, "info", "counts, size, volume, entropy and sensor model", options, info);
  CLI::App* two = add(commands, map, "compare", "compares two maps of the same frame and resolution, voxel by voxel",
                      options, compare_maps);
  two->add_option("other", options->other, "the second map")->required();
  add_map_check_command(commands, map);
  CLI::App* picture = add(commands, map, "render", "draws the map as PNG", options, render);
  picture->add_option("--out", options->out, "file to write: .png")->required();
  picture->add_option("--view", options->view, "top, side or front")->capture_default_str();
  picture->add_option("--height-min", options->height_min_m, "voxels below this height are left out, m");
  picture->add_option(
      "--height-max", options->height_max_m,
      "voxels above this height are left out, m; default: a view from above is cut open below the ceiling");
  picture->add_flag("--classes", options->classes, "colours by class instead of height; grey: no label");
  picture->add_option("--trajectory", options->trajectory, "path to draw over the map (TUM)");
  picture->add_option("--ground-truth", options->ground_truth,
                      "path to draw dashed (TUM); with --trajectory it is moved into that frame");
  picture->add_option("--scale", options->pixels_per_m, "pixels per metre; default: from the size of the map")
      ->check(app::above_zero);
  CLI::App* other = add(commands, map, "export", "writes the map in another format", options, export_map);
  other->add_option("--out", options->out, "file to write: .cairn, .ot, .bt, .ply or .pcd")->required();
  add_map_pull_command(commands, map);
  add_costmap_command(commands, map);
}

}  // namespace cairn::cli
