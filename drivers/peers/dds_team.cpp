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

namespace cairn::peer_link {
namespace {

constexpr int kHistory = 768;  // datagrams that wait to be read
constexpr const char* kTopic = "cairn/datagrams";

/// A handle of Cyclone DDS; deleting the participant deletes all that belongs to it.
using Entity = dds_entity_t;

Error failed(const char* what, Entity code) {
  return {Errc::kIo, "Cyclone DDS refused", {}, {}, std::string(what) + ": " + dds_strretcode(-code)};
}

/// Teammates with the ports that discovery knocks on. Without ports Cyclone would take all that it may use itself.
std::string peers_xml(const DdsConfig& config) {
  constexpr unsigned kBase = 7400, kOfDomain = 250, kUnicastMeta = 10, kOfParticipant = 2;  // DDSI-RTPS 2.3, 9.6.1.1
  std::string xml;
  for (const std::string& peer : config.peers)
    for (unsigned i = 0; i < config.processes_per_host; ++i)
      xml += fmt::format("<Peer Address=\"{}:{}\"/>", peer,
                         kBase + kOfDomain * config.domain + kUnicastMeta + kOfParticipant * i);
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
      interface, config.processes_per_host, config.lease.count() / 1'000'000, peers_xml(config));
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
    if (domain_ < 0) return failed("domain (are there more on this address than --robots-per-address?)", domain_);
    participant_ = dds_create_participant(config.domain, nullptr, nullptr);
    if (participant_ < 0) return failed("participant", participant_);
    topic_ = dds_create_topic(participant_, &cairn_Datagram_desc, kTopic, nullptr, nullptr);
    return topic_ < 0 ? failed(kTopic, topic_) : begin_reading();
  }

  Result<void> send(std::uint64_t to, std::span<const std::byte> datagram) override {
    if (datagram.size() > LinkFrame::kMaxBytes) return Error{Errc::kMalformed, "not a datagram for a team"};
    const auto writer = writer_to(to);
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
    take_all(reader_, out);
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
    reader_ = dds_create_reader(subscriber, topic_, qos.qos, listener);
    dds_delete_listener(listener);
    return reader_ < 0 ? failed(kTopic, reader_) : Result<void>{};
  }

  Result<Entity> writer_to(std::uint64_t to) {
    if (const auto known = writers_.find(to); known != writers_.end()) return known->second;
    Qos qos;
    const std::string name = partition_of(to);
    qos.partitions({name.c_str()});
    const Entity publisher = dds_create_publisher(participant_, qos.qos, nullptr);
    if (publisher < 0) return failed("publisher", publisher);
    const Entity writer = dds_create_writer(publisher, topic_, qos.qos, nullptr);
    if (writer < 0) return failed("writer", writer);
    writers_[to] = writer;
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
  Entity domain_ = 0, participant_ = 0, topic_ = 0, reader_ = 0;
  std::map<std::uint64_t, Entity> writers_;
};

}  // namespace

Result<std::unique_ptr<DdsTeam>> DdsTeam::open(const DdsConfig& config) {
  auto team = std::make_unique<Team>(config);
  if (const auto begun = team->begin(config); !begun) return begun.error();
  return team;
}

}  // namespace cairn::peer_link
