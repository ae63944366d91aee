// SPDX-License-Identifier: Apache-2.0
// A participant of plain Cyclone DDS on loopback, which asks for what ROS's programs ask for.
#pragma once

#include <dds/dds.h>

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "tools/ros/dds/ros_type.hpp"

namespace cairn::ros {

/// What discovery says of a writer or a reader.
struct Endpoint {
  std::string type, user_data;
  dds_reliability_kind_t reliability{};
  dds_durability_kind_t durability{};
  bool plain_cdr_alone = false;
  bool operator==(const Endpoint&) const = default;
};
using Endpoints = std::map<std::string, Endpoint>;  // by topic

class CycloneRos {
 public:
  explicit CycloneRos(unsigned domain)
      : domain_(dds_create_domain(
            domain,
            "<General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces></General><Discovery>"
            "<ParticipantIndex>auto</ParticipantIndex><Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery>")),
        participant_(dds_create_participant(domain, nullptr, nullptr)),
        writers_(builtin(DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
        readers_(builtin(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)),
        participants_(builtin(DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)) {}
  CycloneRos(const CycloneRos&) = delete;
  CycloneRos& operator=(const CycloneRos&) = delete;
  ~CycloneRos() { dds_delete(domain_); }

  /// With ROS's default QoS, in XCDR1 alone.
  dds_entity_t reader(const char* topic, const RosType& type, bool latched = false) const {
    return dds_create_reader(participant_, made(topic, type), ros_qos(latched).get(), nullptr);
  }
  dds_entity_t writer(const char* topic, const RosType& type) const {
    return dds_create_writer(participant_, made(topic, type), ros_qos(false).get(), nullptr);
  }

  /// Of others, as far as they have been discovered.
  [[nodiscard]] Endpoints writers() const { return endpoints(writers_); }
  [[nodiscard]] Endpoints readers() const { return endpoints(readers_); }
  /// User data of another participant; empty: none was discovered that has some.
  [[nodiscard]] std::string participant_data() const {
    std::string data;
    each<dds_builtintopic_participant_t>(participants_, [&](const auto& one) {
      if (const std::string text = user_data_of(one.qos); !text.empty()) data = text;
    });
    return data;
  }

 private:
  struct DeleteQos {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
  };
  using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

  static Qos ros_qos(bool latched) {
    Qos qos(dds_create_qos());
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_durability(qos.get(), latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 10);
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &plain_cdr);
    return qos;
  }
  dds_entity_t made(const char* topic, const RosType& type) const {
    return dds_create_topic(participant_, type.descriptor, topic, nullptr, nullptr);
  }
  dds_entity_t builtin(dds_entity_t topic) const { return dds_create_reader(participant_, topic, nullptr, nullptr); }

  template <class Sample, class Handle>
  static void each(dds_entity_t reader, Handle handle) {
    constexpr std::size_t kMost = 64;
    void* samples[kMost] = {};
    dds_sample_info_t infos[kMost];
    const int count = dds_read(reader, samples, infos, kMost, kMost);
    for (int i = 0; i < count; ++i)
      if (infos[i].valid_data && infos[i].instance_state == DDS_ALIVE_INSTANCE_STATE)
        handle(*static_cast<const Sample*>(samples[i]));
    if (count > 0) (void)dds_return_loan(reader, samples, count);
  }
  static std::string user_data_of(const dds_qos_t* qos) {
    void* bytes = nullptr;
    std::size_t size = 0;
    if (!dds_qget_userdata(qos, &bytes, &size) || bytes == nullptr) return {};
    std::string text(static_cast<const char*>(bytes), size);
    dds_free(bytes);
    return text;
  }
  static bool plain_cdr_alone(const dds_qos_t* qos) {
    std::uint32_t count = 0;
    dds_data_representation_id_t* forms = nullptr;
    if (!dds_qget_data_representation(qos, &count, &forms)) return true;  // the default of those that say nothing
    const bool alone = count == 1 && forms[0] == DDS_DATA_REPRESENTATION_XCDR1;
    dds_free(forms);
    return alone;
  }
  static Endpoints endpoints(dds_entity_t reader) {
    Endpoints all;
    each<dds_builtintopic_endpoint_t>(reader, [&](const dds_builtintopic_endpoint_t& one) {
      if (!std::string(one.topic_name).starts_with("r")) return;
      Endpoint& endpoint = all[one.topic_name];
      endpoint.type = one.type_name;
      endpoint.user_data = user_data_of(one.qos);
      endpoint.plain_cdr_alone = plain_cdr_alone(one.qos);
      dds_duration_t blocking = 0;
      (void)dds_qget_reliability(one.qos, &endpoint.reliability, &blocking);
      (void)dds_qget_durability(one.qos, &endpoint.durability);
    });
    return all;
  }

  dds_entity_t domain_, participant_, writers_, readers_, participants_;
};

/// The next message of a reader, handed to `handle(message)`; false: none has come.
template <class Message, class Handle>
bool take_one(dds_entity_t reader, Handle handle) {
  void* samples[1] = {};
  dds_sample_info_t info;
  const int count = dds_take(reader, samples, &info, 1, 1);
  const bool good = count == 1 && info.valid_data;
  if (good) handle(*static_cast<const Message*>(samples[0]));
  if (count > 0) (void)dds_return_loan(reader, samples, count);
  return good;
}

}  // namespace cairn::ros
