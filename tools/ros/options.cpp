// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/options.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "drivers/clients/messages/subscribe.hpp"
#include "tools/ros/dds/ros_name.hpp"

namespace cairn::ros {
namespace {

/// The two options that choose how maps are written.
struct MapChoice {
  std::string map = "binary", tree = "octree";
  double period_s = 2;
  [[nodiscard]] bool color() const { return tree == "color"; }
  [[nodiscard]] bool full() const { return map == "full"; }
};

GraphForm graph_of(const std::string& word) {
  if (word == "humble") return GraphForm::kHumble;
  return word == "iron" ? GraphForm::kIron : GraphForm::kNone;
}

void add_core(CLI::App& app, Options& options) {
  app.add_option("--socket", options.socket, "robot.sock of the core")->capture_default_str();
  app.add_option("--command-socket", options.command_socket,
                 "command.sock of the core; without it nothing on the network can command the robot");
  app.add_option("--namespace", options.topics.name, "of the topics; default: the robot's name")
      ->check(namespace_fault);
  app.add_option("--frame-prefix", options.topics.frame_prefix,
                 "before the names of frames, such as husky/; default: none");
  app.add_option("--pose-rate", options.topics.pose_hz, "poses a second; 0: those of scans alone")
      ->check(CLI::Range(0.0, clients::SubscribeMessage::kMaxPose_hz))
      ->capture_default_str();
  app.add_option("--picture-rate", options.topics.picture_hz, "pictures a second of each camera, at most; 0: all")
      ->check(CLI::Range(0.0, clients::SubscribeMessage::kMaxPose_hz))
      ->capture_default_str();
}

void add_maps(CLI::App& app, MapChoice& maps) {
  app.add_option("--map", maps.map, "occupied or free alone, or log-odds")
      ->check(CLI::IsMember({"binary", "full"}))
      ->capture_default_str();
  app.add_option("--tree", maps.tree, "color: log-odds, and occupied voxels in the colours of their classes")
      ->check(CLI::IsMember({"octree", "color"}))
      ->capture_default_str();
  app.add_option("--map-period", maps.period_s, "seconds from one map to the next, at least")
      ->check(CLI::Range(0.2, 3600.0))
      ->capture_default_str();
}

void add_network(CLI::App& app, Options& options) {
  app.add_option("--domain", options.network.domain, "as ROS_DOMAIN_ID")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0U, 232U))
      ->capture_default_str();
  app.add_option("--interface", options.network.interface, "network interface, by name or address");
  app.add_option("--peer", options.network.peers,
                 "address of another machine, where multicast does not pass; again for each");
}

void add_graph(CLI::App& app, std::string& graph) {
  app.add_option("--graph", graph, "show this program as a node: to Humble, or to Iron and all later releases")
      ->check(CLI::IsMember({"none", "humble", "iron"}))
      ->capture_default_str();
}

MapForm form_of(const MapChoice& maps) {
  if (maps.color()) return MapForm::kColor;
  return maps.full() ? MapForm::kFull : MapForm::kBinary;
}

}  // namespace

std::optional<int> parse(int argc, char** argv, Options& options) {
  CLI::App app("shows a running core to programs of ROS 2, and passes on their commands; no ROS is needed here");
  MapChoice maps;
  std::string graph = "none";
  add_core(app, options);
  add_maps(app, maps);
  add_network(app, options);
  add_graph(app, graph);
  try {
    app.parse(argc, argv);
    if (maps.color() && app.count("--map") > 0 && !maps.full())
      throw CLI::ValidationError("--tree color", "a binary map has no colours; leave --map out, or write --map full");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.graph = graph_of(graph);
  options.topics.map = form_of(maps);
  options.topics.map_period = from_seconds(maps.period_s);
  if (const char* more = std::getenv("CYCLONEDDS_URI")) options.network.more = more;
  return std::nullopt;
}

}  // namespace cairn::ros
