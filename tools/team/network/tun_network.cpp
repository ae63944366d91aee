// SPDX-License-Identifier: Apache-2.0
#include <sched.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>

#include "tools/team/network/network.hpp"
#include "tools/team/network/tun_device.hpp"

namespace cairn::team_run {
namespace {

constexpr Index kMostAddresses = 200;

std::string address_of(Index robot) { return "10.77.0." + std::to_string(robot + 1); }

/// To whom an IPv4 packet goes (RFC 791, 3.1: the address is in bytes 16 to 19); nobody for all else.
std::optional<Index> receiver_of(std::span<const std::byte> packet, Index robots) {
  constexpr std::size_t kHeader = 20;
  if (packet.size() < kHeader || std::to_integer<int>(packet[0]) >> 4 != 4) return std::nullopt;
  const auto part = [&](std::size_t i) { return std::to_integer<Index>(packet[16 + i]); };
  if (part(0) != 10 || part(1) != 77 || part(2) != 0 || part(3) == 0 || part(3) > robots) return std::nullopt;
  return part(3) - 1;
}

class TunNetwork final : public Network {
 public:
  TunNetwork(const LinkConfig& link, std::vector<TunNamespace> robots)
      : robots_(std::move(robots)), radio_(link, robots_.size()) {}

  [[nodiscard]] std::string_view kind() const override {
    return "a network namespace for each robot, joined by TUN devices";
  }
  [[nodiscard]] int namespace_of(Index robot) const override { return robots_[robot].network.get(); }
  [[nodiscard]] std::vector<std::string> peer_arguments(Index robot) const override {
    std::vector<std::string> words{"--interface", kTunName, "--socket", kCoreSocket};
    for (Index other = 0; other < robots_.size(); ++other)
      if (other != robot) words.insert(words.end(), {"--peer", address_of(other)});
    return words;
  }
  void add_waits(std::vector<pollfd>& waits) const override {
    for (const TunNamespace& robot : robots_) waits.push_back({robot.packets.get(), POLLIN, 0});
  }
  [[nodiscard]] const Radio& radio() const override { return radio_; }

  void pump(Time now) override {
    for (Index robot = 0; robot < robots_.size(); ++robot) take(robot, now);
    arrived_.clear();
    radio_.arrived(now, arrived_);
    // A device whose queue is full drops the packet, as a radio would.
    for (const Radio::Packet& packet : arrived_)
      (void)!::write(robots_[packet.to].packets.get(), packet.bytes.data(), packet.bytes.size());
  }

 private:
  void take(Index robot, Time now) {
    for (;;) {
      const ssize_t got = ::read(robots_[robot].packets.get(), buffer_.data(), buffer_.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return;
      const std::span packet(buffer_.data(), static_cast<std::size_t>(got));
      const auto to = receiver_of(packet, robots_.size());
      if (to && *to != robot) radio_.offer(robot, *to, packet, now);
    }
  }

  std::vector<TunNamespace> robots_;
  Radio radio_;
  std::array<std::byte, 65536> buffer_{};
  std::vector<Radio::Packet> arrived_;
};

}  // namespace

Result<std::unique_ptr<Network>> make_tun_network(const LinkConfig& link, Index robots) {
  if (robots > kMostAddresses) return Error{Errc::kLimit, "too many robots for one network"};
  const auto home = current_network();
  if (!home) return home.error();
  std::vector<TunNamespace> made;
  while (made.size() < robots) {
    auto robot = make_tun_namespace(address_of(made.size()));
    if (!robot && robot.error().where == kNoNamespace && enter_user_namespace())
      robot = make_tun_namespace(address_of(made.size()));
    if (!robot) {
      (void)::setns(home->get(), CLONE_NEWNET);
      return robot.error();
    }
    made.push_back(*std::move(robot));
  }
  // Who needed a user namespace may not go back, and needs no network either.
  (void)::setns(home->get(), CLONE_NEWNET);
  return std::unique_ptr<Network>(std::make_unique<TunNetwork>(link, std::move(made)));
}

}  // namespace cairn::team_run
