// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string_view>

#include "tools/ros/dds/ros_participant.hpp"

namespace cairn::ros {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

/// Of a writer or a reader. It has the form of data and the user data that ROS's own have: never empty user data, with
/// which each node of rmw_cyclonedds would log a warning.
[[nodiscard]] Qos qos_of(TopicUse use, const char* type_hash);
[[nodiscard]] Qos participant_qos();

}  // namespace cairn::ros
