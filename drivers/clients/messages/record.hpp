// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.hpp"

// What the core and its clients send each other over robot.sock and command.sock: one record in each message of a
// SOCK_SEQPACKET socket. All numbers are little endian, in metres, radians and nanoseconds.
namespace cairn::clients {

/// What a record is about. The numbers are fixed: add to them, and never use one again for something else.
enum class RecordKind : std::uint8_t {
  // robot.sock, core → client
  kHello = 1,
  kPose = 2,
  kState = 3,
  kTiles = 4,
  kScan = 5,
  kEvent = 6,
  kPeople = 7,
  kCamera = 8,
  kPicture = 9,
  kWheels = 10,
  kThermal = 11,
  // robot.sock, client → core
  kSubscribe = 32,
  // command.sock, client → core
  kCommand = 64,
  // command.sock, core → client
  kGreeting = 96,
  kAnswer = 97,
};

/// One record: 16 bytes of header, then the body.
struct Record {
  static constexpr std::size_t kHeaderBytes = 16, kMaxBody = 32 * 1024;
  static constexpr std::uint8_t kVersion = 1;

  RecordKind kind{};
  std::uint32_t sequence = 0;  ///< counts the records of one sender in one connection; a gap is a loss
  std::span<const std::byte> body;
};

/// Begins a record in `out`, whose memory is reused. Append the body, then call end_record().
void begin_record(RecordKind kind, std::uint32_t sequence, std::vector<std::byte>& out);
/// Writes the checksum into the header. The header is "CRN", version (1 byte), kind (1), 3 zeros, sequence (4), and
/// XXH32 of all that is before and after it (4). The body has at most kMaxBody bytes.
void end_record(std::vector<std::byte>& out);

/// The record's body points into `message`. Errors: kTruncated, kLimit (longer than any), kUnsupported (another
/// version), kMalformed (no such record, or the checksum differs).
[[nodiscard]] Result<Record> decode_record(std::span<const std::byte> message);

}  // namespace cairn::clients
