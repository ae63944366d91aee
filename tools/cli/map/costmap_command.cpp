// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/costmap_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "hal/clock.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/client/map_mirror.hpp"
#include "onboard/client/view/costmap.hpp"
#include "tools/cli/map/costmap_lines.hpp"
#include "tools/cli/stream/core_stream.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using client::Costmap;

struct CostmapArguments {
  fs::path socket, out;
  client::CostmapConfig robot;
  double rate_hz = 2, seconds = 0;
  bool json = false, follow = false;
};

/// The own map of a core, and where its robot is.
class Surroundings {
 public:
  Result<bool> take(client::StreamMessage& message) {
    if (const auto* hello = std::get_if<client::HelloMessage>(&message))
      mirror_.emplace(clients::TileMap::kOwn, hello->resolution_m);
    if (const auto* pose = std::get_if<client::PoseMessage>(&message)) pose_ = *pose;
    if (const auto* tiles = std::get_if<client::TilesMessage>(&message); tiles != nullptr && mirror_)
      if (const auto taken = mirror_->take(*tiles); !taken) return taken.error();
    return !complete();
  }
  /// A core that maps says where it is ten times a second.
  [[nodiscard]] Result<bool> idle() const {
    constexpr Duration kSilent = std::chrono::seconds(10);
    if (LiveClock().now() - since_ < kSilent) return true;
    return Error{Errc::kNotFound,
                 pose_ ? "the core sends no map" : "the core does not know where it is",
                 {},
                 {},
                 "`cairn top` shows whether scans come in"};
  }
  [[nodiscard]] bool complete() const { return mirror_ && mirror_->caught_up() && pose_; }
  [[nodiscard]] const client::MapMirror& mirror() const { return *mirror_; }
  [[nodiscard]] const client::PoseMessage& pose() const { return *pose_; }

 private:
  std::optional<client::MapMirror> mirror_;
  std::optional<client::PoseMessage> pose_;
  Time since_ = LiveClock().now();
};

/// As Nav2's map server has it: 254 drivable, 0 lethal, 205 unknown. The first row is the one with the highest y.
std::string to_pgm(const Costmap& map) {
  constexpr char kDrivable = static_cast<char>(254), kLethal = 0, kUnknown = static_cast<char>(205);
  std::string text = fmt::format("P5\n{0} {0}\n255\n", map.cells);
  for (int y = map.cells - 1; y >= 0; --y)
    for (int x = 0; x < map.cells; ++x) {
      const std::uint8_t cost = map.at(x, y);
      text += cost == Costmap::kUnknown ? kUnknown : cost == Costmap::kLethal ? kLethal : kDrivable;
    }
  return text;
}

/// As the map server of Nav2 reads it.
std::string to_yaml(const Costmap& map, const fs::path& picture) {
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{:.6f}, {:.6f}, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      picture.filename().string(), map.resolution_m, map.x_m, map.y_m);
}

int save(const CostmapArguments& a, const Surroundings& found) {
  const client::PlannerView view(found.mirror(), nullptr, std::nullopt);
  const Costmap map = client::make_costmap(view, found.pose().T_odom_base.mean, a.robot);
  fs::path yaml = a.out;
  yaml.replace_extension(".yaml");
  if (const auto saved = write_file_atomic(a.out, to_pgm(map)); !saved) return app::fail(saved.error());
  if (const auto saved = write_file_atomic(yaml, to_yaml(map, a.out)); !saved) return app::fail(saved.error());
  const auto count = [&](auto is) { return std::ranges::count_if(map.cost, is); };
  const auto lethal = count([](std::uint8_t c) { return c == Costmap::kLethal; }),
             unknown = count([](std::uint8_t c) { return c == Costmap::kUnknown; });
  const auto cells = static_cast<std::ptrdiff_t>(map.cost.size());
  if (a.json)
    return app::print({{"out", a.out.string()},
                       {"cells", cells},
                       {"lethal", lethal},
                       {"unknown", unknown},
                       {"resolution_m", map.resolution_m},
                       {"x_m", map.x_m},
                       {"y_m", map.y_m}});
  std::cout << fmt::format("{} and {}: {} cells of {} m, {} drivable, {} lethal, {} unknown\n", a.out.string(),
                           yaml.string(), cells, map.resolution_m, cells - lethal - unknown, lethal, unknown);
  return app::kDone;
}

/// A line now and then, until `seconds` are over or Ctrl-C comes.
int follow(const CostmapArguments& a) {
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kOwnTiles);
  wants.add(clients::Stream::kPose);
  Surroundings found;
  std::optional<Time> next;
  const Time end = a.seconds > 0 ? LiveClock().now() + from_seconds(a.seconds) : Time::max();
  const auto take = [&](client::StreamMessage& message) -> Result<bool> {
    const bool pose = std::holds_alternative<client::PoseMessage>(message);
    if (const auto taken = found.take(message); !taken) return taken.error();
    if (!pose || !found.complete() || (next && found.pose().stamp < *next)) return LiveClock().now() < end;
    next = found.pose().stamp + from_seconds(1 / a.rate_hz);
    const client::PlannerView view(found.mirror(), nullptr, std::nullopt);
    std::cout << costmap_line(view, found.pose(), a.robot).dump() << std::endl;
    return LiveClock().now() < end && std::cout.good();
  };
  const auto read = read_core(a.socket, wants, take, [&]() -> Result<bool> {
    if (LiveClock().now() >= end) return false;
    return next ? Result<bool>(true) : found.idle();
  });
  return read ? app::kDone : app::fail(at(a.socket.string(), read.error()));
}

int make(const CostmapArguments& a) {
  if (a.follow) return follow(a);
  if (a.out.empty())
    return app::fail({Errc::kInvalidConfig, "name a file with --out, or follow the robot with --follow", {}, {}, {}});
  if (a.out.extension() != ".pgm")
    return app::fail({Errc::kInvalidConfig, "a costmap is a .pgm with a .yaml beside it", a.out.string(), {}, {}});
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kOwnTiles);
  wants.add(clients::Stream::kPose);
  Surroundings found;
  const auto read = read_core(
      a.socket, wants, [&](client::StreamMessage& message) { return found.take(message); },
      [&] { return found.idle(); });
  if (!read) return app::fail(at(a.socket.string(), read.error()));
  if (!found.complete()) return app::fail(app::interrupted(a.socket.string(), "the core has no map and pose yet"));
  return save(a, found);
}

}  // namespace

void add_costmap_command(app::Commands& commands, CLI::App& map) {
  auto* sub = map.add_subcommand("costmap", "saves what a running robot can drive on, for Nav2's map server");
  auto a = std::make_shared<CostmapArguments>();
  sub->add_option("--socket", a->socket, "socket of the core: robot.sock in the folder of its --sockets")
      ->default_val(client::kRobotSocket);
  auto* out = sub->add_option("--out", a->out, "picture to write, .pgm; its .yaml goes beside it");
  const auto number = [&](const char* name, double& value, double most, const char* what) {
    sub->add_option(name, value, what)->check(CLI::Range(0.0, most))->capture_default_str();
  };
  number("--size", a->robot.size_m, 200, "edge of the square around the robot, m");
  number("--height", a->robot.height_m, 10, "clearance that the robot needs above the ground, m");
  number("--step", a->robot.step_m, 2, "highest step that it climbs, m");
  auto* json = sub->add_flag("--json", a->json, "one JSON object on stdout");
  auto* follow = sub->add_flag("--follow", a->follow, "instead of a picture: a line of JSON now and then, until Ctrl-C")
                     ->excludes(out)
                     ->excludes(json);
  sub->add_option("--rate", a->rate_hz, "lines a second")->check(CLI::Range(0.1, 10.0))->default_val(2)->needs(follow);
  sub->add_option("--seconds", a->seconds, "ends after so long")->check(app::above_zero)->needs(follow);
  sub->callback([&commands, a] { commands.job = [a] { return make(*a); }; });
}

}  // namespace cairn::cli
