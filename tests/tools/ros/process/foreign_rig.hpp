// SPDX-License-Identifier: Apache-2.0
// cairn-ros beside a core, and another vendor's DDS.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/tools/ros/process/fast_dds.hpp"
#include "tests/tools/ros/process/ros_rig.hpp"

namespace cairn::ros {

using fast::Fields;
using fast::Payload;

class ForeignRos : public RosRig {
 protected:
  ForeignRos() : ros_side_(domain_number()) {}

  /// The first message of a topic of /husky_1, or none in five minutes.
  std::optional<Payload> first(const std::string& topic, const std::string& type, const fast::DataReaderQos& qos) {
    auto* reader = ros_side_.reader(topic, type, qos);
    std::optional<Payload> payload;
    EXPECT_TRUE(until([&] { return (payload = fast::take(reader)).has_value(); })) << topic;
    return payload;
  }

  /// Seconds after the epoch at which a core's stamps lie.
  static void expect_stamp(Fields& fields) {
    EXPECT_GE(fields.next<std::int32_t>(), 1'700'000'100);
    EXPECT_EQ(fields.next<std::uint32_t>() % 20'000'000, 0U) << "stamps of the stand-in are multiples of 20 ms";
  }
  static void expect_transform(Fields& fields, const SE3& T) {
    EXPECT_EQ(fields.reals(3), std::vector<double>(T.translation().begin(), T.translation().end()));
    const auto& q = T.quaternion();
    EXPECT_EQ(fields.reals(4), (std::vector{q.x(), q.y(), q.z(), q.w()}));
  }

  fast::FastRos ros_side_;
};

}  // namespace cairn::ros
