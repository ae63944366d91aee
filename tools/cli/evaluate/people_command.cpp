// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/sight/open_people.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/evaluate/people_error.hpp"
#include "tools/cli/evaluate/people_file.hpp"
#include "tools/cli/evaluate/people_pictures.hpp"
#include "tools/cli/evaluate/people_scene.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kGate_m = 0.75;

struct PeopleOptions {
  fs::path run, truth;
  double within_m = PeopleZone{}.within_m;
  std::string view = "any";
  fs::path details;
  bool json = false;
};

/// What the command compares.
struct PeopleMaterial {
  std::vector<PeopleScan> scans;
  std::vector<PersonRow> tracks_world;
  std::vector<ViewAngle> angles;  // empty: all around
};

/// What it finds.
struct PeopleFigures {
  PeopleError in_view, around;
  std::size_t scans = 0, rows = 0, without_scan = 0;
};

fs::path file_of(const PeopleOptions& options) {
  std::error_code ignored;
  return fs::is_directory(options.truth, ignored) ? options.truth / "people.csv" : options.truth;
}

/// The run's rows in the world.
Result<std::vector<PersonRow>> tracks_in_world(const fs::path& run, const fs::path& recording) {
  auto rows = read_people(run / "people.csv");
  if (!rows) return rows;
  const auto T_world_odom = place_of_odom(run, recording);
  if (!T_world_odom) return T_world_odom.error();
  for (PersonRow& row : *rows) row.position = middle_in_world(*T_world_odom, row.position, row.ground);
  return rows;
}

/// What the run itself says it ran with, or else what its recording says.
Result<app::RobotProfile> profile_of(const fs::path& run, const app::RobotProfile& recorded) {
  const fs::path config = run / "config.yaml";
  std::error_code ignored;
  if (!fs::exists(config, ignored)) return recorded;
  auto own = app::choose_profile(config, {});
  if (!own) return own.error();
  return std::move(own->profile);
}

/// Whom the robot could see, and when: the LiDAR says it, or the label pictures where no LiDAR's scans were looked at.
Result<std::vector<PeopleScan>> visible_people(const fs::path& folder, const fs::path& run,
                                               const app::RobotProfile& profile, std::span<const PersonRow> truth,
                                               std::span<const PersonRow> tracks) {
  const auto recording = recording::load_recording(folder);
  if (!recording) return at(folder.string(), recording.error());
  const auto own = profile_of(run, profile);
  if (!own) return own.error();
  const bool by_depth = app::people_by_depth(*own, recording->sources);
  if (has(*recording, recording::kVelodyne) && !by_depth) return people_scans(folder, profile, truth);
  const auto stamps = label_stamps(folder);
  if (!stamps) return stamps.error();
  const Duration period = from_seconds(1 / (by_depth ? own->depth.map.rate_hz : own->stereo.map_rate_hz));
  return people_pictures(folder, profile, truth, judged_stamps(*stamps, tracks, period));
}

Result<PeopleMaterial> gather(const PeopleOptions& options) {
  const fs::path file = file_of(options), recording = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const auto truth = read_people(file);
  if (!truth) return truth.error();
  auto tracks = tracks_in_world(options.run, recording);
  if (!tracks) return tracks.error();
  const auto chosen = app::choose_profile({}, recording);
  if (!chosen) return chosen.error();
  PeopleMaterial material{.scans = {}, .tracks_world = *std::move(tracks), .angles = {}};
  if (options.view != "around") {
    auto angles = view_angles(recording, chosen->profile, options.view);
    if (!angles) return angles.error();
    material.angles = *std::move(angles);
  }
  auto scans = visible_people(recording, options.run, chosen->profile, *truth, material.tracks_world);
  if (!scans) return scans.error();
  material.scans = *std::move(scans);
  return material;
}

PeopleError judge(const JoinedPeople& joined) {
  PeopleJudge judge(kGate_m);
  for (const PeopleFrame& frame : joined.frames) judge.add(frame);
  const std::size_t n = joined.frames.size();
  const Duration all = n < 2 ? Duration{} : joined.frames.back().stamp - joined.frames.front().stamp;
  return judge.finish(n < 2 ? Duration{} : all / static_cast<std::int64_t>(n - 1));
}

Result<PeopleFigures> compare(const PeopleOptions& options) {
  const auto material = gather(options);
  if (!material) return material.error();
  const auto seen = join(material->scans, material->tracks_world, {options.within_m, material->angles});
  const auto around = join(material->scans, material->tracks_world, {options.within_m, {}});
  const std::size_t rows = material->tracks_world.size();
  if (rows > 0 && seen.without_scan == rows)
    return Error{Errc::kMalformed,
                 "no time of the run's people is that of a scan",
                 (options.run / "people.csv").string(),
                 {},
                 "give the recording that the run is of"};
  return PeopleFigures{judge(seen), judge(around), material->scans.size(), rows, seen.without_scan};
}

report::Json to_json(const PeopleError& e) {
  const auto number = [](std::optional<double> value) { return value ? report::Json(*value) : report::Json(nullptr); };
  return {{"precision", number(e.precision())},
          {"recall", number(e.recall())},
          {"mota", number(e.mota())},
          {"id_switches", e.id_switches},
          {"position_rmse_m", number(e.position_rmse_m())},
          {"ghost_p95_s", e.ghost_p95_s()},
          {"people", e.people},
          {"found", e.found},
          {"false_tracks", e.false_tracks},
          {"ghosts", e.ghosts_s.size()}};
}

report::Json to_json(const PeopleOptions& options, const PeopleFigures& f) {
  report::Json json = to_json(f.in_view);
  json["around"] = to_json(f.around);
  json["view"] = options.view;
  json["within_m"] = options.within_m;
  json["scans"] = f.scans;
  json["rows"] = f.rows;
  json["rows_without_scan"] = f.without_scan;
  return json;
}

void print(const std::string& where, const PeopleError& e) {
  const auto number = [](std::optional<double> value) { return value ? fmt::format("{:.4f}", *value) : "-"; };
  std::cout << fmt::format("{}: {} sightings of people, {} found, {} false\n", where, e.people, e.found,
                           e.false_tracks);
  std::cout << fmt::format("  precision {}  recall {}  MOTA {}  id switches {}\n", number(e.precision()),
                           number(e.recall()), number(e.mota()), e.id_switches);
  std::cout << fmt::format("  position  {} m RMS\n", number(e.position_rmse_m()));
  std::cout << fmt::format("  ghosts    {} times a track was at nobody, 95 % of them for at most {:.2f} s\n",
                           e.ghosts_s.size(), e.ghost_p95_s());
}

/// A row for each person and track that counts in a scan.
Result<void> write_details(const fs::path& file, const PeopleError& error) {
  std::string text = "t,what,person,track,x,y\n";
  for (const PeopleDetail& d : error.details)
    text += fmt::format("{:.6f},{},{},{},{:.3f},{:.3f}\n", to_seconds(d.stamp.time_since_epoch()), d.what, d.person,
                        d.track, d.position.x(), d.position.y());
  return write_file_atomic(file, text);
}

int evaluate_people(const PeopleOptions& options) {
  const auto figures = app::while_working("finding whom the robot could see", [&] { return compare(options); });
  if (!figures) return app::fail(figures.error());
  if (!options.details.empty())
    if (const auto written = write_details(options.details, figures->in_view); !written)
      return app::fail(written.error());
  if (options.json) return app::print(to_json(options, *figures));
  print(options.view == "around" ? "all around" : "in the cameras' view", figures->in_view);
  print("all around", figures->around);
  if (figures->without_scan > 0)
    std::cout << fmt::format("{} of {} rows have no scan at their time\n", figures->without_scan, figures->rows);
  return app::kDone;
}

}  // namespace

void add_evaluate_people_command(app::Commands& commands, CLI::App& evaluate) {
  CLI::App* sub = evaluate.add_subcommand("people", "compares a run's people with those of a simulated recording");
  const auto o = std::make_shared<PeopleOptions>();
  sub->footer(
      "A person counts while at least 5 returns of the LiDAR are at them. Without a LiDAR, or where the run looked for "
      "people in the clouds of a depth camera, at least 125 pixels of "
      "RECORDING/labels must show them. A track less than 0.75 m away finds them. "
      "The first common pose of both trajectories aligns the frames.");
  sub->add_option("run", o->run, "folder of a run: its people.csv and trajectory.tum")
      ->required()
      ->check(CLI::ExistingDirectory);
  sub->add_option("--ground-truth", o->truth,
                  "the simulated recording, or its people.csv; the other files are beside it")
      ->required()
      ->check(CLI::ExistingPath);
  sub->add_option("--within", o->within_m, "people and tracks farther from the robot do not count, m")
      ->check(app::above_zero)
      ->capture_default_str();
  sub->add_option("--view", o->view,
                  "which people count in the first figures: in view of any camera, of one camera, or all around; "
                  "the figures called around are always of everybody")
      ->check(CLI::IsMember({"any", "camera", "thermal", "around"}))
      ->capture_default_str();
  sub->add_option("--details", o->details,
                  "a file for a row of each scan and person or track of the first figures: t,what,person,track,x,y in "
                  "the world; what is found, missed, switched or false");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return evaluate_people(*o); }; });
}

}  // namespace cairn::cli
