// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tools/ros/bridge/robot_topics.hpp"
#include "tools/ros/dds/ros_graph.hpp"
#include "tools/ros/dds/ros_participant.hpp"

namespace cairn::ros {

/// The command line of cairn-ros.
struct Options {
  std::string socket = client::kRobotSocket;
  std::string command_socket;  ///< empty: nothing on the network can command the robot
  TopicOptions topics;         ///< an empty name: the robot's own
  RosNetwork network;
  GraphForm graph = GraphForm::kNone;
};

/// Fills `options`. None: go on; otherwise the exit code, after a message to the terminal.
[[nodiscard]] std::optional<int> parse(int argc, char** argv, Options& options);

}  // namespace cairn::ros
