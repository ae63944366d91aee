// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/import_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/recording/import/import.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {
namespace {

using recording::ImportOptions;
using recording::ImportReport;

struct ImportArguments {
  std::string kind;
  ImportOptions import;
  bool overwrite = false, json = false;
};

report::Json to_json(const ImportArguments& options, const ImportReport& r) {
  report::Json json{{"kind", options.kind},
                    {"out", options.import.out.string()},
                    {"items", r.items},
                    {"bytes", r.bytes},
                    {"duration_s", to_seconds(r.last - r.first)},
                    {"model", r.model},
                    {"ground_truth_poses", r.ground_truth_poses},
                    {"pictures", r.pictures},
                    {"profile", r.profile},
                    {"rejected_points", r.rejected_points},
                    {"damaged", r.damaged},
                    {"damage", report::Json::array()}};
  for (const Error& e : r.damage) json["damage"].push_back(to_string(e));
  const auto& absurd = r.absurd_stamps;
  json["absurd_stamps"] = {{"count", absurd.count},
                           {"first_offset", absurd.first_offset ? report::Json(*absurd.first_offset) : nullptr},
                           {"note", r.absurd_stamps_note ? report::Json(to_string(*r.absurd_stamps_note)) : nullptr}};
  return json;
}

void print_report(const ImportArguments& options, const ImportReport& r) {
  const bool packets = options.kind == "velodyne-pcap";
  std::cout << options.import.out.string() << ": " << r.items << (packets ? " packets" : " sweeps") << " in "
            << to_seconds(r.last - r.first) << " s";
  if (!r.model.empty()) std::cout << ", " << r.model;
  if (r.pictures > 0) std::cout << ", " << r.pictures << " pictures" << (r.profile ? " with their calibration" : "");
  if (r.ground_truth_poses > 0) std::cout << ", " << r.ground_truth_poses << " poses of ground truth";
  if (r.rejected_points > 0)
    std::cout << ", " << r.rejected_points
              << (r.rejected_points == 1 ? " invalid point was left out" : " invalid points were left out");
  std::cout << '\n';
  for (const Error& e : r.damage) std::cerr << "cairn: left out: " << to_string(e) << '\n';
  if (r.absurd_stamps_note) std::cerr << "cairn: note: " << to_string(*r.absurd_stamps_note) << '\n';
  if (r.damaged > r.damage.size()) std::cerr << "cairn: left out: " << r.damaged - r.damage.size() << " more\n";
}

/// Options that were given and would change nothing with this kind of data.
Result<void> check_kind(const CLI::App& sub, const std::string& kind) {
  const bool capture = kind == "velodyne-pcap";
  const std::array<const char*, 2> of_others =
      capture ? std::array{"--rate", "--deskewed"} : std::array{"--data-port", "--position-port"};
  for (const char* option : of_others)
    if (sub.count(option) > 0)
      return Error{Errc::kInvalidConfig,
                   "would change nothing",
                   option,
                   {},
                   std::string(capture ? "the packets of a capture carry their times and are kept as they are"
                                       : "this data holds no datagrams") +
                       "; leave the option out"};
  return {};
}

int import_data(ImportArguments options) {
  options.import.overwrite = options.overwrite ? recording::Overwrite::kYes : recording::Overwrite::kNo;
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  if (terminal)
    options.import.progress = [](std::uint64_t items) {
      if (items % 10 == 0) std::fprintf(stderr, "\r%llu imported ", static_cast<unsigned long long>(items));
    };
  app::catch_stop_signals();
  options.import.stop = app::stop_requested;
  const auto report = recording::import(options.kind, options.import);
  if (terminal) std::fputs("\r", stderr);
  if (!report) return app::fail(report.error());
  if (options.json) return app::print(to_json(options, *report));
  print_report(options, *report);
  return app::kDone;
}

}  // namespace

void add_import_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("import", "makes a recording of other data");
  auto o = std::make_shared<ImportArguments>();
  sub->add_option("kind", o->kind, "velodyne-pcap (a file), kitti-odometry, kitti-raw or pcd-folder (folders)")
      ->required()
      ->check(CLI::IsMember(recording::import_kinds()));
  sub->add_option("source", o->import.source, "the file or folder to import")->required()->check(CLI::ExistingPath);
  sub->add_option("--out", o->import.out, "folder of the new recording")->required();
  sub->add_option("--robot", o->import.robot, "name of the robot")->capture_default_str();
  sub->add_option("--model", o->import.model, "sensor model, if the data does not say it");
  sub->add_option("--rate", o->import.rate_hz, "sweeps per second, if the data does not say it")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  sub->add_option("--deskewed", o->import.deskewed,
                  "true or false: the sweeps are motion-compensated; default: as usual for this kind of data");
  sub->add_option("--data-port", o->import.data_port, "velodyne-pcap: UDP port of the data packets")
      ->capture_default_str();
  sub->add_option("--position-port", o->import.position_port, "velodyne-pcap: UDP port of the position packets")
      ->capture_default_str();
  sub->add_flag("--overwrite", o->overwrite, "replace the recording in --out");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o, sub] {
    commands.job = [o, sub] {
      if (const auto fit = check_kind(*sub, o->kind); !fit) return app::fail(fit.error());
      return import_data(*o);
    };
  });
}

}  // namespace cairn::cli
