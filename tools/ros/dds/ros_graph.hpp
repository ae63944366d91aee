// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "tools/ros/dds/ros_participant.hpp"

namespace cairn::ros {

/// How nodes tell each other which endpoints they have. The topic and the type have the same name in all releases of
/// ROS, but an endpoint's id has another size: a network has the one or the other.
enum class GraphForm : std::uint8_t {
  kNone,    ///< say nothing: topics work, `ros2 node list` does not show this program
  kHumble,  ///< 24 bytes: Humble and before
  kIron,    ///< 16 bytes: Iron and later
};
[[nodiscard]] const RosType& graph_type(GraphForm form);

/// Says which endpoints this program's node has.
class RosGraph {
 public:
  /// The node `name` in the namespace `node_namespace` ("/husky"). Errors: kIo.
  static Result<RosGraph> open(RosParticipant& participant, GraphForm form, std::string node_namespace,
                               std::string name);
  /// Says it again where there are other endpoints than before. Errors: kIo.
  Result<void> tick();

 private:
  RosGraph(RosParticipant& participant, GraphForm form, std::string node_namespace, std::string name)
      : participant_(&participant), form_(form), namespace_(std::move(node_namespace)), name_(std::move(name)) {}

  RosParticipant* participant_;
  GraphForm form_;
  std::string namespace_, name_;
  dds_entity_t writer_ = 0;
  std::size_t endpoints_ = 0;  // that were said
};

}  // namespace cairn::ros
