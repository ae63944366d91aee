// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/thermal/thermal_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/recording/formats/pcd_file.hpp"
#include "hal/clock.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/sight/open_thermal.hpp"
#include "onboard/client/robot_stream.hpp"
#include "onboard/perception/labelling/thermal_joiner.hpp"
#include "tools/cli/projection/odometry_player.hpp"
#include "tools/cli/stream/core_stream.hpp"
#include "tools/cli/thermal/thermal_map.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct ThermalArguments {
  fs::path recording, config, socket, out;
  double voxel_m = 0.1;
  std::optional<double> seconds;
  std::optional<std::size_t> pictures;
  bool json = false;
};

/// What the clouds of one drive make.
struct Gathered {
  explicit Gathered(double voxel_m) : map(voxel_m) {}

  /// Places of two epochs have nothing in common, so the newer ones stay.
  Result<void> add(std::uint32_t of_epoch, bool are_celsius, const SE3& T_odom_base,
                   std::span<const ThermalPoint> points) {
    if (epoch && *epoch != of_epoch) map.clear();
    epoch = of_epoch;
    celsius = are_celsius;
    ++clouds;
    return map.add(T_odom_base, points);
  }

  ThermalMap map;
  std::optional<std::uint32_t> epoch;
  bool celsius = false;
  std::size_t clouds = 0, unreadable = 0, scans_without_pose = 0;
};

/// The pictures of a recording, each with its scan.
class RecordedClouds {
 public:
  RecordedClouds(app::ThermalParts parts, Gathered& gathered)
      : camera_(std::move(parts.camera)), joiner_(std::move(parts.lifter)), gathered_(gathered) {}

  Result<void> play(OdometryPlayer& player) {
    const auto played = player.play({.packet = [this](const Packet& packet) { take(packet); },
                                     .scan =
                                         [this](const Scan&, const odometry::OdometryUpdate& m, std::uint32_t epoch) {
                                           joiner_.add_scan(m.stamp, m.T_odom_base.mean, m.twist, epoch, m.points_base);
                                         },
                                     .after = [this] { return join(); }});
    gathered_.unreadable += player.unreadable();
    gathered_.scans_without_pose = player.scans_without_pose();
    return played;
  }

 private:
  void take(const Packet& packet) {
    const auto frame = camera_.decode(packet);
    if (!frame) ++gathered_.unreadable;
    if (frame && *frame != nullptr && !(*frame)->correcting) joiner_.add_picture((*frame)->values);
  }
  Result<void> join() {
    for (;;) {
      const auto made = joiner_.next(cloud_);
      if (!made) return made.error();
      if (!*made) return {};
      if (auto added = gathered_.add(cloud_.epoch, cloud_.celsius, cloud_.T_odom_base, cloud_.points); !added)
        return added;
    }
  }

  thermal::Thermal camera_;
  labelling::ThermalJoiner joiner_;
  labelling::ThermalCloud cloud_;  // reused
  Gathered& gathered_;
};

Result<void> gather_recorded(const ThermalArguments& a, Gathered& gathered) {
  const auto chosen = app::choose_profile(a.config, a.recording);
  if (!chosen) return chosen.error();
  auto player = OdometryPlayer::open(a.recording, chosen->profile, recording::kThermal);
  if (!player) return player.error();
  const auto sources = recording::load_recording(a.recording);
  if (!sources) return sources.error();
  auto parts = app::open_thermal(chosen->profile, sources->sources);
  if (!parts) return at(a.recording.string(), parts.error());
  return RecordedClouds(*std::move(parts), gathered).play(**player);
}

/// Until Ctrl-C, or until the seconds or the pictures are full.
Result<void> gather_live(const ThermalArguments& a, Gathered& gathered) {
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kThermal);
  wants.add(clients::Stream::kEvents);  // why nothing comes
  const LiveClock clock;
  const Time start = clock.now();
  const auto take = [&](client::StreamMessage& message) -> Result<bool> {
    if (const auto* cloud = std::get_if<client::ThermalMessage>(&message))
      if (const auto added = gathered.add(cloud->epoch, cloud->celsius, cloud->T_odom_base, cloud->points); !added)
        return added.error();
    if (const auto* event = std::get_if<client::EventMessage>(&message))
      if (event->stage == "clients") std::cerr << "cairn: " << event->what << '\n';
    return !a.pictures || gathered.clouds < *a.pictures;
  };
  return read_core(a.socket, wants, take,
                   [&]() -> Result<bool> { return !a.seconds || to_seconds(clock.now() - start) < *a.seconds; });
}

Result<void> save(const ThermalArguments& a, const Gathered& gathered, const std::vector<ThermalMap::Mean>& means) {
  const std::array<std::string_view, 5> fields{"x", "y", "z", gathered.celsius ? "temperature" : "counts", "points"};
  std::vector<float> values;
  values.reserve(fields.size() * means.size());
  for (const auto& [point, value, points] : means)
    values.insert(values.end(), {point.x(), point.y(), point.z(), value, points});
  return write_file_atomic(a.out, recording::to_pcd(fields, values));
}

int report(const ThermalArguments& a, const Gathered& gathered, const std::vector<ThermalMap::Mean>& means) {
  const auto [low, high] = std::ranges::minmax(means, {}, &ThermalMap::Mean::value);
  if (a.json)
    return app::print({{"out", a.out.string()},
                       {"pictures", gathered.clouds},
                       {"points", means.size()},
                       {"unit", gathered.celsius ? "celsius" : "counts"},
                       {"lowest", low.value},
                       {"highest", high.value},
                       {"unreadable", gathered.unreadable},
                       {"scans_without_pose", gathered.scans_without_pose}});
  std::cout << fmt::format("{}: {} points of {} pictures, {:.1f} to {:.1f} {}\n", a.out.string(), means.size(),
                           gathered.clouds, low.value, high.value, gathered.celsius ? "°C" : "counts");
  if (gathered.unreadable > 0) std::cout << gathered.unreadable << " packets could not be read\n";
  if (gathered.scans_without_pose > 0) std::cout << gathered.scans_without_pose << " scans have no pose\n";
  return app::kDone;
}

int make_thermal_cloud(const ThermalArguments& a) {
  if (a.out.extension() != ".pcd")
    return app::fail({Errc::kInvalidConfig, "the name must end in .pcd", "--out " + a.out.string(), {}, {}});
  Gathered gathered(a.voxel_m);
  const bool live = a.recording.empty();
  const auto done =
      live ? gather_live(a, gathered)
           : app::while_working("joining scans and thermal pictures", [&] { return gather_recorded(a, gathered); });
  if (!done) return app::fail(done.error());
  const auto means = gathered.map.means();
  if (means.empty())
    return app::fail({Errc::kNotFound,
                      "no picture of the thermal camera met a scan",
                      (live ? a.socket : a.recording).string(),
                      {},
                      live ? "`cairn top` shows what comes" : "`cairn inspect` shows what it holds"});
  if (const auto saved = save(a, gathered, means); !saved) return app::fail(saved.error());
  return report(a, gathered, means);
}

}  // namespace

void add_thermal_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand(
      "thermal", "makes a cloud of what a thermal camera measured at the LiDAR's points, of a recording or a core");
  const auto a = std::make_shared<ThermalArguments>();
  auto* recording = sub->add_option("recording", a->recording, "folder of a recording; without it: a running core");
  recording->check(CLI::ExistingDirectory);
  sub->add_option("--config", a->config, "robot profile with mounts and intrinsics; default: the recording's own")
      ->needs(recording);
  auto* socket =
      sub->add_option("--socket", a->socket, "socket of the core: robot.sock in the folder of its --sockets");
  socket->default_val(client::kRobotSocket)->excludes(recording);
  sub->add_option("--seconds", a->seconds, "of a core, end after this time; default: at Ctrl-C")
      ->check(app::above_zero)
      ->excludes(recording);
  sub->add_option("--pictures", a->pictures, "of a core, end after so many pictures that met a scan")
      ->check(CLI::Range(1, 1'000'000))
      ->excludes(recording);
  sub->add_option("--out", a->out, "file to write: .pcd with x y z temperature points, in odom")->required();
  sub->add_option("--voxel", a->voxel_m, "one point in each cube of this edge: the mean of all in it, m")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  sub->add_flag("--json", a->json, "one JSON object on stdout");
  sub->callback([&commands, a] { commands.job = [a] { return make_thermal_cloud(*a); }; });
}

}  // namespace cairn::cli
