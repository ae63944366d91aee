// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hal/ports.hpp"
#include "tests/drivers/camera/frames.hpp"

// A camera that looks at nothing but grey, for the tasks that look at pictures.
namespace cairn::app::grey {

inline constexpr int kEyeWidth = 8, kEyeHeight = 4;
inline constexpr Duration kFrame = std::chrono::microseconds(66'667);

/// Grey pictures at 15 Hz; the left half of picture n has the value n.
inline Packet picture(int n, int width = 2 * kEyeWidth) {
  camera::test::Bytes pixels(static_cast<std::size_t>(width * kEyeHeight));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<std::byte>(static_cast<int>(i) % width < width / 2 ? n : 255);
  const auto header = camera::test::header_of(camera::FrameFormat::kGrey, static_cast<std::uint32_t>(width), kEyeHeight,
                                              static_cast<std::uint32_t>(width));
  Packet packet = camera::test::packet_of(header, pixels, static_cast<std::uint64_t>(n));
  packet.arrival = Time{std::chrono::seconds(1)} + n * kFrame;
  return packet;
}

inline std::vector<Packet> pictures(int count) {
  std::vector<Packet> all;
  for (int n = 0; n < count; ++n) all.push_back(picture(n));
  return all;
}

class Pictures final : public Source {
 public:
  explicit Pictures(std::vector<Packet> packets) : packets_(std::move(packets)) {}
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (next_ == packets_.size()) return Poll::kEnd;
    packet = packets_[next_++];
    return Poll::kPacket;
  }

 private:
  std::vector<Packet> packets_;
  std::size_t next_ = 0;
};

}  // namespace cairn::app::grey
