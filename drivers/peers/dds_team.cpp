// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/dds_team.hpp"

#include <cairn.h>  // of idl/cairn.idl
#include <dds/dds.h>
#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <map>
#include <utility>

#include "drivers/peers/link_frame.hpp"

namespace cairn::peers {
namespace {

constexpr int kHistory = 256;  // datagrams that wait to be read, by topic
constexpr std::array kTopics{"cairn/hello", "cairn/digest", "cairn/items"};

/// A handle of Cyclone DDS; deleting the participant deletes all that belongs to it.
using Entity = dds_entity_t;

Error failed(const char* what, Entity code) {
  return {Errc::kIo, "Cyclone DDS refused", {}, {}, std::string(what) + ": " + dds_strretcode(-code)};
}

std::string peers_xml(const std::vector<std::string>& peers) {
  std::string xml;
  for (const std::string& peer : peers) xml += "<Peer Address=\"" + peer + "\"/>";
  return xml;
}

/// Small datagrams, no multicast, few participants, short leases, little memory.
std::string configuration(const DdsConfig& config) {
  const std::string interface =
      config.interface.empty()
          ? ""
          : fmt::format("<Interfaces><NetworkInterface {}=\"{}\"/></Interfaces>",
                        config.interface.find('.') == std::string::npos ? "name" : "address", config.interface);
  return fmt::format(
      "<General>{}<AllowMulticast>false</AllowMulticast><MaxMessageSize>1400B</MaxMessageSize>"
      "<FragmentSize>1300B</FragmentSize></General>"
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>"
      "<LeaseDuration>{}ms</LeaseDuration><SPDPInterval>2s</SPDPInterval><Peers>{}</Peers></Discovery>"
      "<Internal><SynchronousDeliveryLatencyBound>inf</SynchronousDeliveryLatencyBound></Internal>",
      interface, config.processes_per_host - 1, config.lease.count() / 1'000'000, peers_xml(config.peers));
}

struct Qos {
  Qos() : qos(dds_create_qos()) {
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kHistory);
    dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);  // what is for all is not for oneself
  }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  ~Qos() { dds_delete_qos(qos); }
  void partitions(std::vector<const char*> names) {
    dds_qset_partition(qos, static_cast<std::uint32_t>(names.size()), names.data());
  }
  dds_qos_t* qos;
};

void wake(Entity /*reader*/, void* fd) { (void)eventfd_write(*static_cast<int*>(fd), 1); }

std::string partition_of(std::uint64_t robot) { return robot == 0 ? "to/all" : "to/" + std::to_string(robot); }

class Team final : public DdsTeam {
 public:
  explicit Team(const DdsConfig& config) : self_(config.robot), wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() override {
    dds_delete(domain_);
    close(wake_fd_);
  }

  Result<void> begin(const DdsConfig& config) {
    domain_ = dds_create_domain(config.domain, configuration(config).c_str());
    if (domain_ < 0) return failed("domain", domain_);
    participant_ = dds_create_participant(config.domain, nullptr, nullptr);
    if (participant_ < 0) return failed("participant", participant_);
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      topics_[i] = dds_create_topic(participant_, &cairn_Datagram_desc, kTopics[i], nullptr, nullptr);
      if (topics_[i] < 0) return failed(kTopics[i], topics_[i]);
    }
    return begin_reading();
  }

  Result<void> send(std::uint64_t to, std::span<const std::byte> datagram) override {
    const std::size_t topic = topic_of(datagram);
    if (datagram.size() > LinkFrame::kMaxBytes || topic == kTopics.size())
      return Error{Errc::kMalformed, "not a datagram for a team"};
    const auto writer = writer_to(to, topic);
    if (!writer) return writer.error();
    cairn_Datagram sample{};
    sample.sender = self_;
    sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(datagram.size());
    sample.bytes._buffer = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(datagram.data()));
    const dds_return_t written = dds_write(*writer, &sample);
    if (written != DDS_RETCODE_OK && written != DDS_RETCODE_TIMEOUT) return failed("write", written);
    return {};
  }

  void receive(std::vector<Received>& out) override {
    eventfd_t count = 0;
    (void)eventfd_read(wake_fd_, &count);
    for (const Entity reader : readers_) take_all(reader, out);
  }

  [[nodiscard]] int readable_fd() const override { return wake_fd_; }

 private:
  Result<void> begin_reading() {
    Qos qos;
    const std::string own = partition_of(self_);
    qos.partitions({"to/all", own.c_str()});
    const Entity subscriber = dds_create_subscriber(participant_, qos.qos, nullptr);
    if (subscriber < 0) return failed("subscriber", subscriber);
    dds_listener_t* listener = dds_create_listener(&wake_fd_);
    dds_lset_data_available(listener, wake);
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      readers_[i] = dds_create_reader(subscriber, topics_[i], qos.qos, listener);
    dds_delete_listener(listener);
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      if (readers_[i] < 0) return failed(kTopics[i], readers_[i]);
    return {};
  }

  /// By its kind, the second byte.
  static std::size_t topic_of(std::span<const std::byte> datagram) {
    const auto kind = datagram.size() < 2 ? 0U : std::to_integer<unsigned>(datagram[1]);
    return kind >= 1 && kind <= kTopics.size() ? kind - 1 : kTopics.size();
  }

  Result<Entity> writer_to(std::uint64_t to, std::size_t topic) {
    auto& writers = writers_.try_emplace(to).first->second;
    if (writers[topic] > 0) return writers[topic];
    Qos qos;
    const std::string name = partition_of(to);
    qos.partitions({name.c_str()});
    const Entity publisher = dds_create_publisher(participant_, qos.qos, nullptr);
    if (publisher < 0) return failed("publisher", publisher);
    const Entity writer = dds_create_writer(publisher, topics_[topic], qos.qos, nullptr);
    if (writer < 0) return failed("writer", writer);
    writers[topic] = writer;
    return writer;
  }

  static void take_all(Entity reader, std::vector<Received>& out) {
    constexpr int kAtOnce = 32;
    for (int taken = kAtOnce; taken == kAtOnce;) {
      std::array<void*, kAtOnce> samples{};
      std::array<dds_sample_info_t, kAtOnce> infos{};
      taken = dds_take(reader, samples.data(), infos.data(), kAtOnce, kAtOnce);
      for (int i = 0; i < taken; ++i) {
        if (!infos[static_cast<std::size_t>(i)].valid_data) continue;
        const auto& sample = *static_cast<const cairn_Datagram*>(samples[static_cast<std::size_t>(i)]);
        const auto* bytes = reinterpret_cast<const std::byte*>(sample.bytes._buffer);
        out.push_back({sample.sender, {bytes, bytes + sample.bytes._length}});
      }
      if (taken > 0) (void)dds_return_loan(reader, samples.data(), taken);
    }
  }

  std::uint64_t self_;
  int wake_fd_;
  Entity domain_ = 0, participant_ = 0;
  std::array<Entity, kTopics.size()> topics_{}, readers_{};
  std::map<std::uint64_t, std::array<Entity, kTopics.size()>> writers_;
};

}  // namespace

Result<std::unique_ptr<DdsTeam>> DdsTeam::open(const DdsConfig& config) {
  auto team = std::make_unique<Team>(config);
  if (const auto begun = team->begin(config); !begun) return begun.error();
  return team;
}

}  // namespace cairn::peers
