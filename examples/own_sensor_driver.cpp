// SPDX-License-Identifier: Apache-2.0
// A driver for a LiDAR of a made-up protocol, recorded and replayed through the same decoder:  own_sensor_driver FOLDER
//
// A packet holds 36 shots of a turn: the number of the first one (2 bytes), then their ranges in mm (2 bytes each).
#include <cairn/hal/bytes.hpp>
#include <cairn/hal/files/packet_log.hpp>
#include <cairn/hal/ports.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

using namespace cairn;
constexpr std::size_t kShots = 36, kTurn = 360, kPacketBytes = 2 + 2 * kShots;
constexpr Duration kShot = std::chrono::microseconds(100);
constexpr PacketLogFormat kFormat{
    .magic = 0x3152'4C4D, .most_bytes = kPacketBytes, .contents = "packets of a made-up LiDAR"};

/// Bytes to scans: no device, no file, no clock. Refuses what it cannot be.
class Decoder final : public ScanDecoder {
 public:
  Result<const Scan*> decode(const Packet& packet) override {
    ByteReader in(packet.payload());
    const auto first = in.read<std::uint16_t>();
    if (packet.bytes.size() != kPacketBytes || !first || *first >= kTurn || *first % kShots != 0)
      return Error{Errc::kMalformed, "no packet of this LiDAR", {}, {}, {}};
    if (*first == 0) begin(packet.arrival);
    for (std::size_t shot = *first; shot < *first + kShots; ++shot) add(shot, *in.read<std::uint16_t>());
    scan_.valid.end = packet.arrival;
    return *first + kShots == kTurn ? &scan_ : nullptr;
  }
  const Scan* expire(Time) override { return nullptr; }
  const Scan* flush() override { return nullptr; }

 private:
  void begin(Time arrival) {
    scan_ = {};
    scan_.valid.start = arrival - kShot * kShots;
  }
  void add(std::size_t shot, std::uint16_t range_mm) {
    const float angle = static_cast<float>(shot) * 2 * static_cast<float>(M_PI) / kTurn,
                range = 1e-3F * static_cast<float>(range_mm);
    scan_.cloud.push_back({range * std::cos(angle), range * std::sin(angle), 0}, 0,
                          static_cast<std::uint32_t>(kShot.count() * static_cast<Duration::rep>(shot)), 0,
                          ReturnType::kStrongest);
  }
  Scan scan_;
};

/// The device: a round room of 5 m. A real one would read a socket here, and take the kernel's stamp.
class Device final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration) override {
    if (sent_ == 30) return Poll::kEnd;
    packet.bytes.clear();
    append_le(packet.bytes, static_cast<std::uint16_t>(sent_ * kShots % kTurn));
    for (std::size_t i = 0; i < kShots; ++i) append_le(packet.bytes, static_cast<std::uint16_t>(5000 + i));
    packet.sequence = sent_++;
    packet.arrival = Time{kShot * kShots * static_cast<Duration::rep>(sent_)};
    return Poll::kPacket;
  }

 private:
  std::size_t sent_ = 0;
};

/// Decodes all that comes, and keeps it in `log` where that is given. Returns the sum of all coordinates.
double run(Source& source, std::vector<std::byte>* log) {
  Decoder decoder;
  Packet packet;
  double sum = 0;
  while (source.next(packet, {}).value_or(Poll::kEnd) == Poll::kPacket) {
    if (log != nullptr) (void)append_log_record(kFormat, packet, *log);
    if (const auto scan = decoder.decode(packet); scan && *scan != nullptr)
      for (const auto& p : (*scan)->cloud.xyz) sum += static_cast<double>(p.sum());
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path file = std::filesystem::path(argc > 1 ? argv[1] : ".") / "made-up.log";
  std::vector<std::byte> log;
  append_log_header(kFormat, log);
  Device device;
  const double live = run(device, &log);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));

  auto recorded = PacketLogSource::open(file, kFormat, SourceId{});
  if (!recorded) return std::fprintf(stderr, "%s\n", to_string(recorded.error()).c_str()), 1;
  const double replayed = run(**recorded, nullptr);
  std::printf("live %.6f, replayed %.6f: %s\n", live, replayed, live == replayed ? "the same" : "NOT the same");
  return live == replayed ? 0 : 1;
}
