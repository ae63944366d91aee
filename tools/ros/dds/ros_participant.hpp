// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/ros/dds/ros_type.hpp"

namespace cairn::ros {

/// How the program takes part in a network of ROS.
struct RosNetwork {
  unsigned domain = 0;             ///< ROS_DOMAIN_ID
  std::string interface;           ///< name or address of the network interface; empty: the DDS library chooses
  std::vector<std::string> peers;  ///< addresses that are asked directly, where multicast does not pass
  /// More settings of Cyclone DDS, as in CYCLONEDDS_URI; they win.
  std::string more;
};

/// What a topic is for. Decides its QoS.
enum class TopicUse : std::uint8_t {
  kEvent,    ///< reliable, the last 10
  kStream,   ///< reliable, the last 5; also matches readers that ask for best effort, as ROS's do for sensors
  kTf,       ///< reliable, the last 100
  kLatched,  ///< reliable, and the last one goes to readers that come later
  kCommand,  ///< read only: best effort, the last one, so that nothing is sent again when it is old
};

/// A participant that ROS takes for one of its own. Writing waits 5 ms at most.
class RosParticipant {
 public:
  /// Errors: kIo with what Cyclone DDS says.
  static Result<std::unique_ptr<RosParticipant>> open(const RosNetwork& network);
  RosParticipant(const RosParticipant&) = delete;
  RosParticipant& operator=(const RosParticipant&) = delete;
  /// Ends all that was made with it.
  ~RosParticipant();

  /// `topic`: as in ROS, "/husky/odom". Errors: kIo.
  Result<dds_entity_t> writer(const std::string& topic, const RosType& type, TopicUse use);
  Result<dds_entity_t> reader(const std::string& topic, const RosType& type, TopicUse use);
  /// Of what nodes say about themselves: a topic without a name in ROS.
  Result<dds_entity_t> graph_writer(const RosType& type);

  /// Readable when a reader has something. Quiet again after wait_again().
  [[nodiscard]] int readable_fd() const { return wake_fd_; }
  void wait_again();

  [[nodiscard]] dds_entity_t handle() const { return participant_; }
  /// All that were made here, but for the graph's.
  [[nodiscard]] const std::vector<dds_entity_t>& writers() const { return writers_; }
  [[nodiscard]] const std::vector<dds_entity_t>& readers() const { return readers_; }

 private:
  RosParticipant();
  Result<void> begin(const RosNetwork& network);
  Result<dds_entity_t> make_writer(const std::string& dds_topic, const RosType& type, TopicUse use);

  int wake_fd_;
  dds_entity_t domain_ = 0, participant_ = 0;
  std::vector<dds_entity_t> writers_, readers_;
};

/// What Cyclone DDS says to a call that failed.
[[nodiscard]] Error dds_error(const std::string& what, dds_return_t code);

}  // namespace cairn::ros
