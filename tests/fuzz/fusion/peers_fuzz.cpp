// SPDX-License-Identifier: Apache-2.0
// A whole session with one robot that hears whatever the bytes say, cut into datagrams: it refuses, or takes what has
// one form only, and keeps within its bounds; and it can still say what it knows.
#include <span>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "hal/bytes.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace cairn;
using namespace cairn::peers;

constexpr std::size_t kHeader = 3;  // length of a datagram, time since the last one

/// What was taken would be written alike.
void check_form(std::span<const std::byte> bytes) {
  const auto decoded = decode_datagram(bytes);
  if (!decoded) return;
  const auto again = encode(*decoded).bytes;
  require(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  auto rest = std::as_bytes(std::span(data, size));
  ExchangeConfig config;
  config.max_bytes_per_robot = 20000;
  config.spare_bytes = 0;
  Exchange robot(1, "robot_1", 7, config);
  Time now{};
  std::vector<Outgoing> out;
  while (rest.size() > kHeader) {
    const std::size_t length = std::min<std::size_t>(rest.size() - kHeader, load_le<std::uint16_t>(rest, 0));
    now += std::chrono::milliseconds(std::to_integer<int>(rest[2]) * 20);
    const auto datagram = rest.subspan(kHeader, length);
    rest = rest.subspan(kHeader + length);
    check_form(datagram);
    (void)robot.receive(datagram, now);
    robot.send(now, out);
  }
  for (const Outgoing& sent : out)
    require(sent.bytes.size() <= kMaxDatagram && decode_datagram(sent.bytes).has_value());
  for (const auto& [id, layer] : robot.layers())
    require(layer.holding.bytes() <= config.max_bytes_per_robot + Holding::kForOthers + 1000);
  (void)robot.take_changes();
  return 0;
}
