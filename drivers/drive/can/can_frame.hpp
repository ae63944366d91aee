// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "hal/packet.hpp"
#include "hal/result.hpp"

namespace cairn::drive {

/// Flags in CanFrame::id, as Linux has them (linux/can.h).
inline constexpr std::uint32_t kExtended = 0x80000000U, kRemote = 0x40000000U, kErrorFrame = 0x20000000U;
inline constexpr std::uint32_t kStandardMask = 0x7FF, kExtendedMask = 0x1FFFFFFF;
/// CanFrame::fd_flags: bit rate switch, error state indicator.
inline constexpr std::uint8_t kFdBitRateSwitch = 1, kFdErrorState = 2;

/// One frame on a CAN bus, classic or FD.
struct CanFrame {
  std::uint32_t id = 0;       ///< 11 or 29 bits and the flags above; in an error frame the classes of link_monitor.hpp
  std::uint8_t length = 0;    ///< bytes of data; a remote frame has none, but asks for so many
  bool fd = false;            ///< CAN FD
  std::uint8_t fd_flags = 0;  ///< of an FD frame
  std::uint8_t raw_dlc = 0;   ///< 9 … 15 in a classic frame of 8 bytes that was sent with such a length code, else 0
  std::array<std::uint8_t, 64> data{};  ///< zero from `length` on

  [[nodiscard]] bool remote() const { return (id & kRemote) != 0; }
  [[nodiscard]] bool error() const { return (id & kErrorFrame) != 0; }
  /// True for a classic data frame with the 11-bit identifier `standard_id`. Drives use no other frames.
  [[nodiscard]] bool is(std::uint32_t standard_id) const { return !fd && id == standard_id; }
  [[nodiscard]] std::span<const std::uint8_t> payload() const { return std::span(data).first(length); }
  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// A classic data frame; at most 8 bytes.
[[nodiscard]] CanFrame make_frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes);

/// Lengths that a CAN FD frame can have: 0 … 8, 12, 16, 20, 24, 32, 48, 64.
[[nodiscard]] bool is_fd_length(std::size_t length);

/// Packet::channel of a frame.
enum class Direction : std::uint16_t {
  kReceived = 0,
  kSent = 1,  ///< by this computer, as the controller confirmed it
};

/// Bytes of a Packet that holds a frame: those of Linux' struct can_frame or struct canfd_frame, little-endian:
///   0 u32 id with flags · 4 u8 length · 5 u8 FD flags · 6 u8 zero · 7 u8 raw DLC (classic) · 8 data (8 or 64 bytes)
inline constexpr std::size_t kClassicBytes = 16, kFdBytes = 72;

/// Errors: kTruncated (neither 16 nor 72 bytes), kMalformed (a length that the format cannot have).
[[nodiscard]] Result<CanFrame> decode_frame(std::span<const std::byte> bytes);
/// Fills `packet.bytes`, reusing its memory.
void encode_frame(const CanFrame& frame, Packet& packet);

}  // namespace cairn::drive
