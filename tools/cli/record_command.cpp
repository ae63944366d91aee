// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/record_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/recording/record.hpp"
#include "drivers/velodyne/udp_source.hpp"
#include "onboard/app/report/report_json.hpp"
#include "onboard/app/robot_profile.hpp"
#include "onboard/app/stop_signal.hpp"

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
};

Recording describe(const RecordArguments& options, const RobotProfile& profile, const Clock& clock) {
  Recording r;
  r.robot = profile.name;
  r.profile = options.config.filename().string();
  r.realtime_offset_ns = LiveClock::realtime_offset().count();
  r.start_utc_ns = r.utc_ns(clock.now());
  recording::SourceEntry lidar{"lidar", std::string(recording::kVelodyne), "lidar.pcap", "lidar",
                               profile.lidar.driver.model};
  lidar.base_sensor_xyz_rpy = Eigen::Map<const Vector6>(profile.lidar.base_xyz_rpy.data());
  lidar.data_port = static_cast<std::uint16_t>(profile.lidar.driver.data_port);
  lidar.position_port = static_cast<std::uint16_t>(profile.lidar.driver.position_port);
  r.sources.push_back(std::move(lidar));
  return r;
}

/// What the network lost cannot be seen in the packets that came; it is kept with the recording.
Json losses(const velodyne::UdpSource::Counters& c) {
  return {{"kernel_drops", c.kernel_drops}, {"foreign", c.foreign},
          {"flooded", c.flooded},           {"truncated", c.truncated},
          {"unstamped", c.unstamped},       {"receive_buffer_bytes", c.receive_buffer_bytes}};
}

recording::RecordOptions record_options(const RecordArguments& options, const RecordingWriter& writer) {
  recording::RecordOptions record;
  if (options.seconds) record.length = from_seconds(*options.seconds);
  record.stop = stop_requested;
  if (::isatty(STDERR_FILENO) != 0)
    record.on_second = [&writer](Duration since_start) {
      std::fprintf(stderr, "\r%.0f s, %llu packets, %.1f MB ", to_seconds(since_start),
                   static_cast<unsigned long long>(writer.packets()),
                   1e-6 * static_cast<double>(writer.payload_bytes()));
    };
  return record;
}

/// One line per sensor: what it sent and what of it was lost or is doubtful.
std::string as_table(const RecordArguments& options, const Recording& recording, const RecordReport& recorded,
                     const RecordingWriter& writer, const velodyne::UdpSource::Counters& c) {
  std::string table = fmt::format("{}: {:.1f} s\n", options.out.string(), to_seconds(recorded.length));
  constexpr auto kRow = "  {:<10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n";
  table += fmt::format(kRow, "sensor", "packets", "MB", "dropped", "flooded", "cut short", "unstamped", "foreign");
  table += fmt::format(kRow, recording.sources[0].id, writer.packets(),
                       fmt::format("{:.1f}", 1e-6 * static_cast<double>(writer.payload_bytes())), c.kernel_drops,
                       c.flooded, c.truncated, c.unstamped, c.foreign);
  if (recorded.source_errors > 0)
    table += fmt::format("  {} errors of the source, at first: {}\n", recorded.source_errors, recorded.first_error);
  return table;
}

int verdict(const RecordArguments& options, std::uint64_t packets) {
  if (packets > 0) return kDone;
  return fail({Errc::kLinkDown,
               "not one packet came in",
               options.out.string(),
               {},
               "check cable, power, the sensor's destination address and the ports of the profile"});
}

int record(const RecordArguments& options) {
  const auto profile = load_profile(options.config);
  if (!profile) return fail(profile.error());
  const LiveClock clock;
  const auto source = velodyne::UdpSource::open(profile->lidar.driver, SourceId{0}, clock);
  if (!source) return fail(source.error());
  Recording description = describe(options, *profile, clock);
  const auto overwrite = options.overwrite ? recording::Overwrite::kYes : recording::Overwrite::kNo;
  auto writer = RecordingWriter::create(options.out, description, overwrite);
  if (!writer) return fail(writer.error());

  catch_stop_signals();
  const auto recorded = recording::record(**source, clock, *writer, record_options(options, *writer));
  if (::isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
  if (!recorded) return fail(recorded.error());
  Json json{{"out", options.out.string()},
            {"packets", writer->packets()},
            {"bytes", writer->payload_bytes()},
            {"duration_s", to_seconds(recorded->length)},
            {"source_errors", recorded->source_errors},
            {"first_error", recorded->first_error},
            {"losses", losses((*source)->counters())}};
  description.notes = "recorded live; losses: " + json["losses"].dump();
  if (const auto saved = recording::save_recording(options.out, description); !saved) return fail(saved.error());
  if (options.json)
    print(json);
  else
    std::cout << as_table(options, description, *recorded, *writer, (*source)->counters());
  return verdict(options, writer->packets());
}

}  // namespace

void add_record_command(Commands& commands) {
  auto* sub = commands.app.add_subcommand("record", "records raw sensor bytes");
  auto o = std::make_shared<RecordArguments>();
  sub->add_option("--config", o->config, "robot profile, such as config/husky.yaml; defaults without one");
  sub->add_option("--out", o->out, "folder of the new recording")->required();
  sub->add_option("--seconds", o->seconds, "end after so much time; otherwise at SIGINT or SIGTERM")
      ->check(CLI::PositiveNumber);
  sub->add_flag("--overwrite", o->overwrite, "replace the recording in --out");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return record(*o); }; });
}

}  // namespace cairn::cli
