// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_pull_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "hal/clock.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/client/map_mirror.hpp"
#include "tools/cli/map/save_map.hpp"
#include "tools/cli/stream/core_stream.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

// A core sends a record ten times a second at least while it has tiles for a client that reads.
constexpr Duration kSilence = std::chrono::seconds(10);

struct PullArguments {
  fs::path socket, out;
  bool team = false, json = false;
};

/// The mirror of one map, and what it took to make it.
class Pull {
 public:
  explicit Pull(clients::TileMap map) : map_(map), heard_(LiveClock().now()) {}

  Result<bool> take(client::StreamMessage& message) {
    heard_ = LiveClock().now();
    if (auto* hello = std::get_if<client::HelloMessage>(&message)) {
      hello_ = std::move(*hello);
      mirror_.emplace(map_, hello_.resolution_m);
    }
    const auto* tiles = std::get_if<client::TilesMessage>(&message);
    if (tiles == nullptr || !mirror_) return true;
    if (const auto taken = mirror_->take(*tiles); !taken) return taken.error();
    return !mirror_->caught_up();
  }
  Result<bool> idle() const {
    if (LiveClock().now() - heard_ < kSilence) return true;
    return Error{Errc::kLinkDown, "the core says nothing", {}, {}, "its task `streams` hangs"};
  }
  [[nodiscard]] const client::MapMirror* mirror() const { return mirror_ ? &*mirror_ : nullptr; }
  [[nodiscard]] const client::HelloMessage& hello() const { return hello_; }

 private:
  clients::TileMap map_;
  Time heard_;
  client::HelloMessage hello_;
  std::optional<client::MapMirror> mirror_;
};

int save_pulled(const PullArguments& a, const Pull& pull) {
  const client::MapMirror& mirror = *pull.mirror();
  if (mirror.tiles() == 0)
    return app::fail({Errc::kNotFound,
                      a.team ? "the core has no map of its team yet" : "the core has mapped nothing yet",
                      a.socket.string(),
                      {},
                      a.team ? "it needs --peers, and its own map" : "`cairn top` shows why"});
  if (const auto saved = save_map(mirror.map(), a.out); !saved) return app::fail(saved.error());
  std::error_code ignored;
  const auto bytes = fs::file_size(a.out, ignored);
  if (a.json)
    return app::print({{"out", a.out.string()},
                       {"bytes", bytes},
                       {"robot", pull.hello().robot},
                       {"map", a.team ? "team" : "own"},
                       {"tiles", mirror.tiles()},
                       {"session", mirror.resume().session},
                       {"epoch", mirror.resume().epoch},
                       {"version", mirror.resume().version}});
  std::cout << fmt::format("{}: {} tiles, {} bytes\n", a.out.string(), mirror.tiles(), bytes);
  return app::kDone;
}

int pull_map(const PullArguments& a) {
  if (const auto named = check_map_name(a.out); !named) return app::fail(named.error());
  client::SubscribeMessage wants;
  wants.add(a.team ? clients::Stream::kTeamTiles : clients::Stream::kOwnTiles);
  Pull pull(a.team ? clients::TileMap::kTeam : clients::TileMap::kOwn);
  const auto read = read_core(
      a.socket, wants, [&](client::StreamMessage& message) { return pull.take(message); }, [&] { return pull.idle(); });
  if (!read) return app::fail(at(a.socket.string(), read.error()));
  if (pull.mirror() == nullptr || !pull.mirror()->caught_up())
    return app::fail(app::interrupted(a.socket.string(), "run it again for all of it"));
  return save_pulled(a, pull);
}

}  // namespace

void add_map_pull_command(app::Commands& commands, CLI::App& map) {
  auto* sub = map.add_subcommand("pull", "saves the map of a running core");
  auto a = std::make_shared<PullArguments>();
  sub->add_option("--socket", a->socket, "socket of the core: robot.sock in the folder of its --sockets")
      ->default_val(client::kRobotSocket);
  sub->add_option("--out", a->out, "file to write: .cairn, .ot, .bt, .ply or .pcd")->required();
  sub->add_flag("--team", a->team, "the map of its team, in the team's frame, instead of its own");
  sub->add_flag("--json", a->json, "one JSON object on stdout");
  sub->callback([&commands, a] { commands.job = [a] { return pull_map(*a); }; });
}

}  // namespace cairn::cli
