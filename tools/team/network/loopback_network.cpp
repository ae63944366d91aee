// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "drivers/peers/domain_claim.hpp"
#include "drivers/peers/local_link.hpp"
#include "tools/team/network/network.hpp"
#include "tools/team/network/tun_device.hpp"

namespace cairn::team_run {
namespace {

using peer_link::LinkFrame;
using peer_link::LocalLink;

constexpr const char* kRadioSocket = "radio.sock";  // in the robot's folder
constexpr Index kMaxRobots = 8;                     // that cairn-peers lets share one address

/// Both ends of what was one local socket: the core's, and the peer process's.
struct Tap {
  File folder;
  LocalLink core, peers;
};

/// A path through the open folder: those of sockets are short.
std::filesystem::path inside(const File& folder, const char* name) {
  return "/proc/self/fd/" + std::to_string(folder.get()) + "/" + name;
}

Result<Tap> open_tap(const std::filesystem::path& path) {
  File folder(::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0)
    return Error{Errc::kIo, "no such folder", path.string(), {}, std::generic_category().message(errno)};
  auto peers = LocalLink::listen(inside(folder, kRadioSocket));
  if (!peers) return peers.error();
  LocalLink core = LocalLink::connect(inside(folder, kCoreSocket));
  return Tap{std::move(folder), std::move(core), *std::move(peers)};
}

class LoopbackNetwork final : public Network {
 public:
  LoopbackNetwork(const LinkConfig& link, std::vector<Tap> taps, peer_link::DomainClaim claim)
      : taps_(std::move(taps)), claim_(std::move(claim)), radio_(link, taps_.size()) {}

  [[nodiscard]] std::string_view kind() const override {
    return "this machine's loopback, with the radio at each robot's local socket (network namespaces are refused here)";
  }
  [[nodiscard]] int namespace_of(Index /*robot*/) const override { return -1; }
  [[nodiscard]] std::vector<std::string> peer_arguments(Index /*robot*/) const override {
    const std::string domain = std::to_string(claim_.domain());
    return {"--interface", "lo",       "--socket", kRadioSocket,           "--peer",
            "127.0.0.1",   "--domain", domain,     "--robots-per-address", std::to_string(taps_.size())};
  }
  void add_waits(std::vector<pollfd>& waits) const override {
    for (const Tap& tap : taps_)
      for (const int fd : {tap.core.readable_fd(), tap.peers.readable_fd()})
        if (fd >= 0) waits.push_back({fd, POLLIN, 0});
  }
  [[nodiscard]] const Radio& radio() const override { return radio_; }

  void pump(Time now) override {
    for (Index robot = 0; robot < taps_.size(); ++robot) take(robot, now);
    arrived_.clear();
    radio_.arrived(now, arrived_);
    for (const Radio::Packet& packet : arrived_)
      taps_[packet.to].core.send({LinkFrame::Kind::kReceived, packet.from + 1, packet.bytes});
  }

 private:
  void take(Index robot, Time now) {
    Tap& tap = taps_[robot];
    tap.core.join();
    tap.peers.join();
    for (LinkFrame frame; tap.core.receive(memory_, frame);)
      if (frame.kind == LinkFrame::Kind::kSend) tap.peers.send(frame);
    for (LinkFrame frame; tap.peers.receive(memory_, frame);)
      if (frame.kind == LinkFrame::Kind::kReceived && frame.robot >= 1 && frame.robot <= taps_.size())
        radio_.offer(frame.robot - 1, robot, frame.bytes, now);
  }

  std::vector<Tap> taps_;
  peer_link::DomainClaim claim_;
  Radio radio_;
  std::vector<std::byte> memory_;
  std::vector<Radio::Packet> arrived_;
};

}  // namespace

Result<std::unique_ptr<Network>> make_loopback_network(const LinkConfig& link,
                                                       const std::vector<std::filesystem::path>& folders) {
  if (folders.size() > kMaxRobots)
    return Error{Errc::kLimit, "too many robots for one loopback", {}, {}, "at most " + std::to_string(kMaxRobots)};
  std::vector<Tap> taps;
  for (const auto& folder : folders) {
    auto tap = open_tap(folder);
    if (!tap) return tap.error();
    taps.push_back(*std::move(tap));
  }
  auto claim = peer_link::DomainClaim::make();
  if (!claim) return claim.error();
  return std::unique_ptr<Network>(std::make_unique<LoopbackNetwork>(link, std::move(taps), *std::move(claim)));
}

}  // namespace cairn::team_run
