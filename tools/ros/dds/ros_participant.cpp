// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/ros_participant.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

#include "tools/ros/dds/qos.hpp"
#include "tools/ros/dds/ros_name.hpp"

namespace cairn::ros {
namespace {

// As ROS advises: each of its programs is a participant.
constexpr int kMostParticipants = 120;

std::string configuration(const RosNetwork& network) {
  const bool by_name = network.interface.find_first_of(".:") == std::string::npos;
  const std::string interfaces = network.interface.empty()
                                     ? ""
                                     : fmt::format("<Interfaces><NetworkInterface {}=\"{}\"/></Interfaces>",
                                                   by_name ? "name" : "address", network.interface);
  std::string peers;
  for (const std::string& peer : network.peers) peers += fmt::format("<Peer Address=\"{}\"/>", peer);
  const std::string ours = fmt::format(
      "<General>{}</General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>{}</Discovery>",
      interfaces, kMostParticipants, peers.empty() ? "" : "<Peers>" + peers + "</Peers>");
  return network.more.empty() ? ours : ours + "," + network.more;
}

void wake(dds_entity_t /*reader*/, void* fd) { (void)eventfd_write(*static_cast<int*>(fd), 1); }

}  // namespace

Error dds_error(const std::string& what, dds_return_t code) {
  return {Errc::kIo, "Cyclone DDS refused", {}, {}, what + ": " + dds_strretcode(-code)};
}

RosParticipant::RosParticipant() : wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

RosParticipant::~RosParticipant() {
  if (domain_ > 0) dds_delete(domain_);
  close(wake_fd_);
}

Result<std::unique_ptr<RosParticipant>> RosParticipant::open(const RosNetwork& network) {
  std::unique_ptr<RosParticipant> participant(new RosParticipant());
  if (const auto begun = participant->begin(network); !begun) return begun.error();
  return participant;
}

Result<void> RosParticipant::begin(const RosNetwork& network) {
  domain_ = dds_create_domain(network.domain, configuration(network).c_str());
  if (domain_ < 0) return dds_error("domain (does the interface exist?)", domain_);
  participant_ = dds_create_participant(network.domain, participant_qos().get(), nullptr);
  if (participant_ < 0) return dds_error("participant", participant_);
  return {};
}

Result<dds_entity_t> RosParticipant::make_writer(const std::string& dds_topic, const RosType& type, TopicUse use) {
  const dds_entity_t topic = dds_create_topic(participant_, type.descriptor, dds_topic.c_str(), nullptr, nullptr);
  if (topic < 0) return dds_error("topic " + dds_topic, topic);
  const dds_entity_t writer = dds_create_writer(participant_, topic, qos_of(use, type.hash).get(), nullptr);
  if (writer < 0) return dds_error("writer of " + dds_topic, writer);
  return writer;
}

Result<dds_entity_t> RosParticipant::writer(const std::string& topic, const RosType& type, TopicUse use) {
  const auto writer = make_writer(dds_topic_of(topic), type, use);
  if (writer) writers_.push_back(*writer);
  return writer;
}

Result<dds_entity_t> RosParticipant::graph_writer(const RosType& type) {
  return make_writer("ros_discovery_info", type, TopicUse::kLatched);
}

Result<dds_entity_t> RosParticipant::reader(const std::string& topic, const RosType& type, TopicUse use) {
  const std::string name = dds_topic_of(topic);
  const dds_entity_t made = dds_create_topic(participant_, type.descriptor, name.c_str(), nullptr, nullptr);
  if (made < 0) return dds_error("topic " + name, made);
  dds_listener_t* listener = dds_create_listener(&wake_fd_);
  dds_lset_data_available(listener, wake);
  const dds_entity_t reader = dds_create_reader(participant_, made, qos_of(use, type.hash).get(), listener);
  dds_delete_listener(listener);
  if (reader < 0) return dds_error("reader of " + name, reader);
  readers_.push_back(reader);
  return reader;
}

void RosParticipant::wait_again() {
  eventfd_t count = 0;
  (void)eventfd_read(wake_fd_, &count);
}

}  // namespace cairn::ros
