// SPDX-License-Identifier: Apache-2.0
// The peer process: all that a robot hears of others comes in here, over Cyclone DDS, and goes to the core over a
// local socket, and the other way round. It knows no device, keeps no state, and may die at any time.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "drivers/peers/bounded_end.hpp"
#include "drivers/peers/dds_log.hpp"
#include "drivers/peers/dds_team.hpp"
#include "drivers/peers/local_link.hpp"
#include "drivers/peers/udp_limiter.hpp"
#include "hal/files/standard_output.hpp"

namespace cairn::peer_link {
namespace {

struct Options {
  DdsConfig dds;
  std::string socket;
  std::size_t bytes_per_second = 32000;
  bool quiet = false;
};

/// The largest datagram with all its headers; two of them always find room after a pause.
constexpr std::size_t kWholeDatagram = LinkFrame::kMaxBytes + 160;

/// From the core to the team, as far as the cap allows: what has to wait does so in the local socket, which is small.
void send_all(LocalLink& link, DdsTeam& team, std::vector<std::byte>& memory) {
  for (LinkFrame frame; udp_room(kWholeDatagram) && link.receive(memory, frame);) {
    if (frame.kind != LinkFrame::Kind::kSend) continue;
    if (const auto sent = team.send(frame.robot, frame.bytes); !sent)
      fmt::print(stderr, "cairn-peers: {}\n", to_string(sent.error()));
  }
}

/// From the team to the core.
void receive_all(DdsTeam& team, LocalLink& link, std::vector<DdsTeam::Received>& received) {
  received.clear();
  team.receive(received);
  for (const auto& datagram : received)
    if (datagram.bytes.size() <= LinkFrame::kMaxBytes)
      link.send({LinkFrame::Kind::kReceived, datagram.sender, datagram.bytes});
}

/// For CLI11: what is wrong with the address of a teammate; empty: nothing. Names are not looked up: a robot should not
/// depend on a name server.
std::string address_fault(const std::string& text) {
  in_addr v4{};
  in6_addr v6{};
  if (::inet_pton(AF_INET, text.c_str(), &v4) == 1 || ::inet_pton(AF_INET6, text.c_str(), &v6) == 1) return {};
  return fmt::format("\"{}\" is no address; write one such as 10.0.0.2", text);
}

int run(const Options& options) {
  limit_udp({options.bytes_per_second});
  const LiveClock clock;
  DdsLog log(clock, "cairn-peers");  // before the team: it outlives Cyclone's threads
  auto team = DdsTeam::open(options.dds);
  if (!team) {
    fmt::print(stderr, "cairn-peers: {}\n", to_string(team.error()));
    return 1;
  }
  LocalLink link = LocalLink::connect(options.socket);
  std::vector<std::byte> memory;
  std::vector<DdsTeam::Received> received;
  while (!end_requested()) {
    constexpr int kRetryMs = 200, kRoomMs = 10;  // a core that is not there yet, or not any more; a cap that is reached
    link.join();
    const bool room = udp_room(kWholeDatagram);
    std::array<pollfd, 2> waited{{{(*team)->readable_fd(), POLLIN, 0}, {room ? link.readable_fd() : -1, POLLIN, 0}}};
    (void)::poll(waited.data(), waited.size(), room ? kRetryMs : kRoomMs);
    log.settle();
    receive_all(**team, link, received);
    send_all(link, **team, memory);
  }
  log.sum_up();
  const UdpCounters counters = udp_counters();
  if (!options.quiet)
    fmt::print(stderr, "cairn-peers: sent {} bytes in {} datagrams, dropped {} for the cap\n", counters.sent_bytes,
               counters.sent, counters.dropped);
  return 0;
}

}  // namespace
}  // namespace cairn::peer_link

int main(int argc, char** argv) {
  using namespace cairn::peer_link;
  Options options;
  CLI::App app("the peer process of a robot: joins its core to the team over Cyclone DDS");
  app.add_option("--robot", options.dds.robot, "this robot's id, its own in the team, not 0")
      ->required()
      ->check(CLI::Range(std::uint64_t{1}, ~std::uint64_t{0}));
  app.add_option("--socket", options.socket, "local socket of the core")->required();
  app.add_option("--peer", options.dds.peers, "address of a teammate, such as 10.0.0.2; again for each")
      ->required()
      ->check(address_fault);
  app.add_option("--robots-per-address", options.dds.processes_per_host,
                 "robots of the team that share an address, this one's included: several on one machine")
      ->check(CLI::Range(1U, 8U))
      ->capture_default_str();
  app.add_option("--interface", options.dds.interface, "network interface, by name or address");
  app.add_option("--domain", options.dds.domain, "DDS domain of the team")->capture_default_str();
  app.add_option("--bytes-per-second", options.bytes_per_second, "cap on all that is sent, headers included")
      ->capture_default_str();
  app.add_flag("--quiet", options.quiet, "no summary at the end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return cairn::end_of_program("cairn-peers", app.exit(error) == 0 ? 0 : 2);
  }
  catch_end_signals();
  return cairn::end_of_program("cairn-peers", run(options));
}
