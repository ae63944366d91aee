// SPDX-License-Identifier: Apache-2.0
// Stands in for a robot's core: says some items, takes in what others say, and ends when every robot of the team knows
// everything. Leaves what it knows, as text, in everything.txt of its folder.
//   stand_in_core ID ROBOTS ITEMS SECONDS      fails after so many seconds
#include <poll.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "drivers/peers/local_link.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/clock.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace {

namespace fs = std::filesystem;
using cairn::peer_link::LinkFrame;
using cairn::peer_link::LocalLink;
using cairn::peers::Exchange;

struct Arguments {
  cairn::peers::RobotId id, robots;
  std::size_t items;
  double seconds;
};

std::vector<std::byte> payload(cairn::peers::RobotId id, std::size_t item) {
  std::mt19937 random(static_cast<unsigned>(1000 * id + item));
  std::vector<std::byte> bytes;
  cairn::peers::encode_tile(cairn::peers::wall_tile_state(random), bytes);
  return bytes;
}

bool knows_all(const Exchange& exchange, const Arguments& a) {
  return exchange.layers().size() == a.robots && std::ranges::all_of(exchange.layers(), [&](const auto& layer) {
           return layer.second.holding.items().size() == a.items;
         });
}

void leave(const Exchange& exchange) {
  std::ofstream out("everything.txt");
  for (const auto& [robot, layer] : exchange.layers())
    for (const auto& [id, item] : layer.holding.items()) {
      out << robot << ' ' << id.code << ' ' << item.version;
      for (const std::byte byte : item.payload) out << ' ' << std::to_integer<int>(byte);
      out << '\n';
    }
}

/// A file of each robot in the folder above says that it knows everything.
bool all_know_all(const Arguments& a) {
  for (cairn::peers::RobotId id = 1; id <= a.robots; ++id)
    if (!fs::exists("../done_" + std::to_string(id))) return false;
  return true;
}

void exchange_once(Exchange& exchange, LocalLink& link, cairn::Time now) {
  std::vector<std::byte> memory;
  link.join();
  for (LinkFrame frame; link.receive(memory, frame);)
    if (const auto taken = exchange.receive(frame.bytes, now); !taken) std::cerr << to_string(taken.error()) << '\n';
  std::vector<cairn::peers::Outgoing> out;
  exchange.send(now, out);
  for (const auto& datagram : out) link.send({LinkFrame::Kind::kSend, datagram.to, datagram.bytes});
}

int run(const Arguments& a) {
  auto link = LocalLink::listen("peers.sock");
  if (!link) return 1;
  cairn::peers::ExchangeConfig config;
  config.bytes_per_second = 60'000;
  Exchange exchange(a.id, "robot_" + std::to_string(a.id), 1, config);
  for (std::size_t i = 0; i < a.items; ++i) exchange.say(cairn::peers::ItemId::tile(0, {i * 977}), payload(a.id, i));
  const cairn::LiveClock clock;
  const cairn::Time last = clock.now() + cairn::from_seconds(a.seconds);
  while (clock.now() < last) {
    pollfd waited{link->readable_fd(), POLLIN, 0};
    (void)::poll(&waited, 1, 20);
    exchange_once(exchange, *link, clock.now());
    if (!knows_all(exchange, a)) continue;
    leave(exchange);
    std::ofstream("../done_" + std::to_string(a.id)) << "done\n";
    if (all_know_all(a)) return 0;
  }
  std::cerr << "frames sent " << link->counters().sent << ", received " << link->counters().received << ", lost "
            << link->counters().lost << '\n';
  for (const auto& [robot, layer] : exchange.layers())
    std::cerr << "robot " << robot << ": " << layer.holding.items().size() << " items\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  return run({std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10),
              std::strtoull(argv[3], nullptr, 10), std::strtod(argv[4], nullptr)});
}
