// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/can_frame.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "hal/bytes.hpp"

namespace cairn::drive {

CanFrame make_frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  if (bytes.size() > 8) std::abort();
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

bool is_fd_length(std::size_t length) {
  constexpr std::array<std::size_t, 7> kLong{12, 16, 20, 24, 32, 48, 64};
  return length <= 8 || std::find(kLong.begin(), kLong.end(), length) != kLong.end();
}

Result<CanFrame> decode_frame(std::span<const std::byte> bytes) {
  if (bytes.size() != kClassicBytes && bytes.size() != kFdBytes)
    return Error{Errc::kTruncated, "a CAN frame has 16 or 72 bytes", {}, bytes.size(), {}};
  CanFrame frame;
  frame.fd = bytes.size() == kFdBytes;
  frame.id = load_le<std::uint32_t>(bytes, 0);
  frame.length = load_le<std::uint8_t>(bytes, 4);
  if (frame.fd ? !is_fd_length(frame.length) : frame.length > 8)
    return Error{Errc::kMalformed, "length of a CAN frame", {}, 4, {}};
  if (frame.fd && (frame.remote() || frame.error()))
    return Error{Errc::kMalformed, "a CAN FD frame is neither remote nor error frame", {}, 0, {}};
  if (frame.fd) {
    frame.fd_flags = load_le<std::uint8_t>(bytes, 5);
  } else if (const auto dlc = load_le<std::uint8_t>(bytes, 7); frame.length == 8 && dlc > 8 && dlc < 16) {
    frame.raw_dlc = dlc;
  }
  if (!frame.remote()) std::memcpy(frame.data.data(), bytes.data() + 8, frame.length);
  return frame;
}

void encode_frame(const CanFrame& frame, Packet& packet) {
  packet.bytes.assign(frame.fd ? kFdBytes : kClassicBytes, std::byte{0});
  std::memcpy(packet.bytes.data(), &frame.id, sizeof frame.id);
  packet.bytes[4] = std::byte{frame.length};
  packet.bytes[5] = std::byte{frame.fd ? frame.fd_flags : std::uint8_t{0}};
  packet.bytes[7] = std::byte{frame.fd ? std::uint8_t{0} : frame.raw_dlc};
  const std::size_t room = packet.bytes.size() - 8;
  if (!frame.remote())
    std::memcpy(packet.bytes.data() + 8, frame.data.data(), std::min<std::size_t>(frame.length, room));
}

}  // namespace cairn::drive
