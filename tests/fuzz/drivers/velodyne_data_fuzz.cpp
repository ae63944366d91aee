// SPDX-License-Identifier: Apache-2.0
// Any sequence of datagrams, in any order and at any time: whatever scans come out are finite, within range, in the
// order of time and bounded in size.
#include <algorithm>
#include <vector>

#include "drivers/velodyne/lidar.hpp"
#include "hal/bytes.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace cairn;
using namespace cairn::velodyne;

struct Checker {
  Time last = Time::min();
  double max_range_m;

  void operator()(const Scan* scan) {
    if (scan == nullptr) return;
    const PointCloud& c = scan->cloud;
    require(scan->valid.start > last && scan->valid.end >= scan->valid.start);
    last = scan->valid.end;
    require(c.intensity.size() == c.size() && c.offset_ns.size() == c.size() && c.ring.size() == c.size() &&
            c.return_type.size() == c.size());
    require(c.size() < 2'000'000);
    require(std::is_sorted(c.offset_ns.begin(), c.offset_ns.end()));
    require(c.empty() || scan->valid.start + Duration{c.offset_ns.back()} <= scan->valid.end);
    for (std::size_t i = 0; i < c.size(); ++i) {
      require(c.xyz[i].allFinite() && c.xyz[i].norm() <= max_range_m + 0.02);
      require(c.ring[i] < kBlockChannels);
    }
  }
};

/// Random bytes hardly ever pass the packet's checks; half of the packets are helped past them.
void repair(std::vector<std::byte>& bytes, const Model& model) {
  if (bytes.size() != kDataBytes) return;
  const auto put16 = [&](std::size_t at, unsigned value) {
    bytes[at] = static_cast<std::byte>(value & 0xFFU);
    bytes[at + 1] = static_cast<std::byte>(value >> 8U);
  };
  const bool dual = bytes[kReturnModeOffset] == std::byte{0x39};
  if (!dual && bytes[kReturnModeOffset] != std::byte{0x38}) bytes[kReturnModeOffset] = std::byte{0x37};
  bytes[kProductOffset] = static_cast<std::byte>(model.product);
  // Most steps are a turning sensor's; the packet's own bytes make one jump now and then.
  const unsigned first = load_le<std::uint16_t>(bytes, kBlockAzimuthOffset);
  const unsigned step = load_le<std::uint8_t>(bytes, kBlockBytes + kBlockAzimuthOffset) % 100U;
  const unsigned jump_at = load_le<std::uint8_t>(bytes, 2 * kBlockBytes + kBlockAzimuthOffset);
  const unsigned jump = load_le<std::uint16_t>(bytes, 3 * kBlockBytes + kBlockAzimuthOffset);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    put16(b * kBlockBytes, kBlockFlag);
    const auto of_pair = static_cast<unsigned>(dual ? b / 2 * 2 : b);
    put16(b * kBlockBytes + kBlockAzimuthOffset,
          (first + of_pair * step + (of_pair >= jump_at ? jump : 0U)) % kAzimuthUnits);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  ByteReader in({reinterpret_cast<const std::byte*>(data), size});
  const auto choice = in.read<std::uint8_t>();
  if (!choice) return 0;
  Config config;
  config.model = models()[*choice % models().size()].name;
  config.rpm = 1200;  // small scans: most of the time would go into making room for them
  config.timeout_turns = 1.1;
  config.cut_angle_deg = (*choice >> 2U) % 4 * 90;
  config.time_source = (*choice & 0x10U) != 0 ? "pps" : "arrival";
  if ((*choice & 0x20U) != 0) config.field_of_view_deg = {300, 60};
  Monitor monitor;
  const auto lidar = Lidar::create(config, SourceId{}, monitor).value();
  lidar->set_utc_offset(std::chrono::hours(438'000));
  Checker check{.max_range_m = config.max_range_m};
  Packet packet;
  Time arrival{std::chrono::seconds(1000)};
  // Records: flags, u16 time since the record before in 10 µs (or, with a flag, ms back), then up to 1206 bytes.
  for (auto flags = in.read<std::uint8_t>(); flags; flags = in.read<std::uint8_t>()) {
    const Duration step = std::chrono::microseconds(10) * in.read<std::uint16_t>().value_or(0);
    arrival += (*flags & 0x08U) != 0 ? -100 * step : step;
    const bool position = (*flags & 0x01U) != 0;
    const auto bytes = in.read_bytes(std::min(position ? kPositionBytes : kDataBytes, in.remaining())).value();
    packet.bytes.assign(bytes.begin(), bytes.end());
    packet.channel = position ? kDefaultPositionPort : kDefaultDataPort;
    packet.truncated = (*flags & 0x02U) != 0;
    packet.arrival = arrival;
    if ((*flags & 0x04U) != 0 && !position) repair(packet.bytes, lidar->model());
    if (const auto scan = lidar->decode(packet)) check(*scan);
    if ((*flags & 0x40U) != 0) check(lidar->expire(arrival + 10 * step));
  }
  check(lidar->flush());
  return 0;
}
