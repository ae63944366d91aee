// SPDX-License-Identifier: Apache-2.0
// Another vendor's DDS, as most of ROS's programs use it: eProsima Fast DDS, with ROS's QoS. Its types are written down
// here by hand from ROS's messages, so that they share nothing with idl/ros2.idl.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cairn::ros::fast {

using eprosima::fastcdr::Cdr;
using namespace eprosima::fastdds::dds;

/// A message as its serialised bytes; the tests read and write them with Fast CDR.
using Payload = std::vector<char>;

class PayloadType final : public TopicDataType {
 public:
  explicit PayloadType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 4U << 20U;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* out) override {
    const auto& bytes = *static_cast<const Payload*>(data);
    if (bytes.size() > out->max_size) return false;
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(out->data));
    out->length = static_cast<std::uint32_t>(bytes.size());
    out->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* in, void* data) override {
    const auto* bytes = reinterpret_cast<const char*>(in->data);
    static_cast<Payload*>(data)->assign(bytes, bytes + in->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Payload*>(data)->size()); };
  }
  void* createData() override { return new Payload; }
  void deleteData(void* data) override { delete static_cast<Payload*>(data); }
  bool getKey(void* /*data*/, eprosima::fastrtps::rtps::InstanceHandle_t* /*handle*/, bool /*md5*/) override {
    return false;
  }
};

/// Reads the fields of a message one after the other.
class Fields {
 public:
  explicit Fields(Payload& payload)
      : buffer_(payload.data(), payload.size()), cdr_(buffer_, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {
    cdr_.read_encapsulation();
  }
  template <class T>
  T next() {
    T value{};
    cdr_ >> value;
    return value;
  }
  std::string text() { return next<std::string>(); }
  std::vector<double> reals(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = next<double>();
    return values;
  }

 private:
  eprosima::fastcdr::FastBuffer buffer_;
  Cdr cdr_;
};

/// Serialises the values one after the other.
template <class... Values>
Payload payload_of(const Values&... values) {
  Payload payload(1024);
  eprosima::fastcdr::FastBuffer buffer(payload.data(), payload.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  (void)(cdr << ... << values);
  payload.resize(cdr.getSerializedDataLength());
  return payload;
}

/// A participant of Fast DDS on loopback alone.
class FastRos {
 public:
  explicit FastRos(unsigned domain) {
    DomainParticipantQos qos;
    auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    loopback->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(loopback);
    eprosima::fastrtps::rtps::Locator_t peer;
    peer.kind = LOCATOR_KIND_UDPv4;
    eprosima::fastrtps::rtps::IPLocator::setIPv4(peer, "127.0.0.1");
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  }
  FastRos(const FastRos&) = delete;
  FastRos& operator=(const FastRos&) = delete;
  ~FastRos() {
    participant_->delete_contained_entities();
    DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  /// `ros_topic` as on the wire, "rt/husky/odom"; with ROS's default QoS, or another.
  DataReader* reader(const std::string& topic, const std::string& type, const DataReaderQos& qos) {
    if (subscriber_ == nullptr) subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    return subscriber_->create_datareader(this->topic(topic, type), qos);
  }
  DataWriter* writer(const std::string& topic, const std::string& type) {
    if (publisher_ == nullptr) publisher_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT);
    DataWriterQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return publisher_->create_datawriter(this->topic(topic, type), qos);
  }

 private:
  Topic* topic(const std::string& topic, const std::string& type) {
    if (auto* known = participant_->lookup_topicdescription(topic)) return dynamic_cast<Topic*>(known);
    TypeSupport support(new PayloadType(type));
    support.register_type(participant_);
    return participant_->create_topic(topic, type, TOPIC_QOS_DEFAULT);
  }

  DomainParticipant* participant_ = nullptr;
  Subscriber* subscriber_ = nullptr;
  Publisher* publisher_ = nullptr;
};

/// rmw's profiles, as ROS's programs ask for them.
inline DataReaderQos ros_qos(ReliabilityQosPolicyKind reliability, DurabilityQosPolicyKind durability, int depth) {
  DataReaderQos qos;
  qos.reliability().kind = reliability;
  qos.durability().kind = durability;
  qos.history().depth = depth;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}
inline DataReaderQos default_qos() { return ros_qos(RELIABLE_RELIABILITY_QOS, VOLATILE_DURABILITY_QOS, 10); }
inline DataReaderQos sensor_qos() { return ros_qos(BEST_EFFORT_RELIABILITY_QOS, VOLATILE_DURABILITY_QOS, 5); }
inline DataReaderQos latched_qos() { return ros_qos(RELIABLE_RELIABILITY_QOS, TRANSIENT_LOCAL_DURABILITY_QOS, 1); }

/// The next message, if one has come.
inline std::optional<Payload> take(DataReader* reader) {
  Payload payload;
  SampleInfo info;
  if (reader->take_next_sample(&payload, &info) != ReturnCode_t::RETCODE_OK || !info.valid_data) return std::nullopt;
  return payload;
}

}  // namespace cairn::ros::fast
