// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/record_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "drivers/recording/new_recording.hpp"
#include "drivers/recording/record.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/door/live_sources.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/calibrate/view_guide.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using recording::Recording;
using recording::RecordingWriter;
using recording::RecordReport;

struct RecordArguments {
  fs::path config, out;
  std::optional<double> seconds;
  bool overwrite = false, json = false;
  std::string board;  ///< empty: nobody is guided
  bool thermal = false, inverted = false;
};

Recording describe(const RecordArguments& options, const app::RobotProfile& profile, const Clock& clock) {
  Recording r;
  r.robot = profile.name;
  r.profile = options.config.filename().string();
  r.realtime_offset_ns = LiveClock::realtime_offset().count();
  r.start_utc_ns = r.utc_ns(clock.now());
  r.sources = app::devices_of(profile);
  return r;
}

/// What was written of each sensor, and what was lost before: that cannot be seen in the packets that came.
report::Json sensors(const std::vector<app::Device>& devices, const RecordingWriter& writer) {
  report::Json json = report::Json::object();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    report::Json& sensor = json[devices[i].id];
    sensor = {{"packets", writer.written()[i].packets}, {"bytes", writer.written()[i].payload_bytes}};
    for (const auto& [name, count] : devices[i].losses()) sensor["losses"][name] = count;
  }
  return json;
}

recording::RecordOptions record_options(const RecordArguments& options, const RecordingWriter& writer) {
  recording::RecordOptions record;
  if (options.seconds) record.length = from_seconds(*options.seconds);
  record.stop = app::stop_requested;
  if (::isatty(STDERR_FILENO) != 0)
    record.on_second = [&writer](Duration since_start) {
      std::fprintf(stderr, "\r%.0f s, %llu packets, %.1f MB ", to_seconds(since_start),
                   static_cast<unsigned long long>(writer.packets()),
                   1e-6 * static_cast<double>(writer.payload_bytes()));
    };
  return record;
}

/// "flooded 3, restarts 1": what has no column of its own.
std::string other_losses(const report::Json& losses) {
  std::string text;
  for (const auto& [name, count] : losses.items())
    if (name != "kernel_drops" && name != "truncated" && name != "unstamped" && count != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.get<std::uint64_t>());
  return text;
}

/// One line per sensor: what it sent and what of it was lost or is doubtful.
std::string as_table(const RecordArguments& options, const report::Json& sensors, const RecordReport& recorded) {
  std::string table = fmt::format("{}: {:.1f} s\n", options.out.string(), to_seconds(recorded.length));
  constexpr auto kRow = "  {:<10} {:>10} {:>10} {:>10} {:>10} {:>10}  {}\n";
  table += fmt::format(kRow, "sensor", "packets", "MB", "dropped", "cut short", "unstamped", "also");
  for (const auto& [id, s] : sensors.items()) {
    const report::Json& losses = s["losses"];
    table +=
        fmt::format(kRow, id, s["packets"].get<std::uint64_t>(), fmt::format("{:.1f}", 1e-6 * s["bytes"].get<double>()),
                    losses.value("kernel_drops", std::uint64_t{0}), losses.value("truncated", std::uint64_t{0}),
                    losses.value("unstamped", std::uint64_t{0}), other_losses(losses));
  }
  if (recorded.source_errors > 0)
    table += fmt::format("  {} errors of the sensors, at first: {}\n", recorded.source_errors, recorded.first_error);
  return table;
}

/// Sensors that gave nothing are the failure of a recording that nobody notices until it is needed.
int verdict(const RecordArguments& options, const report::Json& sensors) {
  std::string silent;
  for (const auto& [id, s] : sensors.items())
    // Edges and frames come when something happens.
    if (s["packets"] == 0 && id != to_string(recording::kGpio) && id != to_string(recording::kDrive))
      silent += (silent.empty() ? "" : ", ") + id;
  if (silent.empty()) return app::kDone;
  return app::fail({Errc::kLinkDown,
                    "not one packet came in",
                    options.out.string() + " (" + silent + ")",
                    {},
                    "check cable, power, the sensor's destination address and the ports of the profile"});
}

report::Json summary(const RecordArguments& options, const std::vector<app::Device>& devices,
                     const RecordingWriter& writer, const RecordReport& recorded) {
  return {{"out", options.out.string()},
          {"packets", writer.packets()},
          {"bytes", writer.payload_bytes()},
          {"duration_s", to_seconds(recorded.length)},
          {"source_errors", recorded.source_errors},
          {"first_error", recorded.first_error},
          {"sensors", sensors(devices, writer)}};
}

/// Who tells which views of a board are missing, and what it looks at.
struct Guidance {
  ViewGuide guide;
  SourceId camera{};
  PictureDecoder decode;
  bool side_by_side = false;
};

/// Null: nobody is guided. Errors kInvalidConfig: no board, or the profile has no such camera.
Result<std::unique_ptr<Guidance>> make_guidance(const RecordArguments& options, const app::RobotProfile& profile) {
  if (options.board.empty() && (options.thermal || options.inverted))
    return Error{Errc::kInvalidConfig, "--thermal and --inverted are of --board", {}, {}, "name the board, too: 9x6"};
  if (options.board.empty()) return std::unique_ptr<Guidance>();
  constexpr double kAnySquare_m = 0.03;  // the tilt of a board does not depend on its size
  const auto board = calibration::parse_board(options.board, kAnySquare_m);
  if (!board) return board.error();
  const auto sources = app::devices_of(profile);
  const auto kind = options.thermal ? recording::kThermal : recording::kCamera;
  const auto camera = std::ranges::find(sources, kind, &recording::SourceEntry::kind);
  if (camera == sources.end())
    return Error{
        Errc::kInvalidConfig,
        "--board needs a camera",
        options.config.string(),
        {},
        options.thermal ? "name thermal.capture.device" : "name camera.capture.device; --thermal: the other one"};
  auto decoder = decoder_of_pictures(profile, options.thermal);
  if (!decoder) return decoder.error();
  return std::make_unique<Guidance>(Guidance{.guide = ViewGuide(*board, options.inverted),
                                             .camera = static_cast<SourceId>(camera - sources.begin()),
                                             .decode = *std::move(decoder),
                                             .side_by_side = !options.thermal && profile.camera.driver.side_by_side});
}

Result<RecordReport> record_all(const RecordArguments& options, const std::vector<app::Device>& devices,
                                const Clock& clock, RecordingWriter& writer, Guidance* guidance) {
  std::vector<Source*> sources;
  for (const app::Device& device : devices) sources.push_back(device.source.get());
  app::LiveSources source(std::move(sources), clock);
  std::optional<GuidedSource> guided;
  if (guidance != nullptr)
    guided.emplace(source, guidance->camera, guidance->decode, guidance->side_by_side, guidance->guide,
                   [guidance] { std::fprintf(stderr, "\r%s\n", guidance->guide.text().c_str()); });
  Source& all = guided ? static_cast<Source&>(*guided) : source;
  auto recorded = recording::record(all, clock, writer, record_options(options, writer));
  if (::isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
  return recorded;
}

/// What a full disk has of a drive cannot be recorded again.
int fail_and_keep(recording::NewRecording& place, Error error) {
  error.detail += (error.detail.empty() ? "" : "; ") + ("what was recorded is in " + place.folder().string());
  place.leave();
  return app::fail(error);
}

int record(const RecordArguments& options) {
  app::catch_stop_signals();  // before the first file: until the first packet is read, seconds may pass
  const auto profile = app::load_profile(options.config);
  if (!profile) return app::fail(profile.error());
  const auto guidance = make_guidance(options, *profile);
  if (!guidance) return app::fail(guidance.error());
  const LiveClock clock;
  const auto devices = app::open_devices_of(*profile, clock);
  if (!devices) return app::fail(devices.error());
  if (devices->empty())
    return app::fail({Errc::kInvalidConfig,
                      "the profile has no device",
                      options.config.string(),
                      {},
                      "name one: camera.capture.device, drive.interface, …"});
  Recording description = describe(options, *profile, clock);
  const auto overwrite = options.overwrite ? recording::Overwrite::kYes : recording::Overwrite::kNo;
  auto place = recording::NewRecording::begin(options.out, overwrite);
  if (!place) return app::fail(place.error());
  auto writer = RecordingWriter::create(place->folder(), description);
  if (!writer) return app::fail(writer.error());
  if (const auto kept = app::keep_profile(place->folder(), *profile); !kept) return app::fail(kept.error());

  const auto recorded = record_all(options, *devices, clock, *writer, guidance->get());
  if (!recorded) return fail_and_keep(*place, recorded.error());
  report::Json json = summary(options, *devices, *writer, *recorded);
  if (const Guidance* g = guidance->get())
    json["board"] = {{"views", g->guide.views()}, {"missing", g->guide.missing()}};
  description.notes = "recorded live; sensors: " + json["sensors"].dump();
  if (const auto saved = recording::save_recording(place->folder(), description); !saved)
    return fail_and_keep(*place, saved.error());
  if (const auto finished = place->finish(); !finished) return app::fail(finished.error());
  if (options.json)
    app::print(json);
  else
    std::cout << as_table(options, json["sensors"], *recorded) << (*guidance ? (*guidance)->guide.text() + "\n" : "");
  return verdict(options, json["sensors"]);
}

}  // namespace

void add_record_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("record", "records raw sensor bytes");
  auto o = std::make_shared<RecordArguments>();
  sub->add_option("--config", o->config, "robot profile, such as config/husky.yaml; default values if not given");
  sub->add_option("--out", o->out, "folder of the new recording")->required();
  sub->add_option("--seconds", o->seconds, "length of the recording, s; without it, until SIGINT or SIGTERM")
      ->check(app::above_zero);
  sub->add_option(
      "--board", o->board,
      "inner corners of a checkerboard, such as 9x6: say which of its views are missing for `cairn calibrate`");
  sub->add_flag("--thermal", o->thermal, "the thermal camera sees the board; default: the colour camera");
  sub->add_flag("--inverted", o->inverted, "squares that are dark on the board are bright in the pictures");
  sub->add_flag("--overwrite", o->overwrite, "replace the recording in --out");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return record(*o); }; });
}

}  // namespace cairn::cli
