// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/record.hpp"

#include <xxhash.h>

#include "hal/bytes.hpp"

namespace cairn::clients {
namespace {

constexpr std::uint32_t kMagic = 0x4E5243;  // "CRN"
constexpr std::uint32_t kMagicMask = 0xFFFFFF;
constexpr std::size_t kVersionAt = 3, kKindAt = 4, kPaddingAt = 5, kSequenceAt = 8, kChecksumAt = 12;

/// Of a message without its checksum.
std::uint32_t checksum(std::span<const std::byte> message) {
  const std::uint32_t head = XXH32(message.data(), kChecksumAt, 0);
  return XXH32(message.data() + Record::kHeaderBytes, message.size() - Record::kHeaderBytes, head);
}

}  // namespace

void begin_record(RecordKind kind, std::uint32_t sequence, std::vector<std::byte>& out) {
  out.clear();
  append_le(out, kMagic | std::uint32_t{Record::kVersion} << 24U);
  append_le(out, std::uint32_t{static_cast<std::uint8_t>(kind)});
  append_le(out, sequence);
  append_le(out, std::uint32_t{0});
}

void end_record(std::vector<std::byte>& out) {
  const std::uint32_t sum = checksum(out);
  std::memcpy(out.data() + kChecksumAt, &sum, sizeof sum);
}

Result<Record> decode_record(std::span<const std::byte> message) {
  if (message.size() < Record::kHeaderBytes) return Error{Errc::kTruncated, "a record shorter than its header"};
  if (message.size() > Record::kHeaderBytes + Record::kMaxBody)
    return Error{Errc::kLimit, "a record longer than any may be"};
  if ((load_le<std::uint32_t>(message, 0) & kMagicMask) != kMagic)
    return Error{Errc::kMalformed, "not a record of Cairn", {}, 0, {}};
  if (load_le<std::uint8_t>(message, kVersionAt) != Record::kVersion)
    return Error{
        Errc::kUnsupported, "a record of another version", {}, kVersionAt, "core and client must be of one release"};
  if ((load_le<std::uint32_t>(message, kKindAt) & ~std::uint32_t{0xFF}) != 0)
    return Error{Errc::kMalformed, "a record whose header cannot be", {}, kPaddingAt, {}};
  if (load_le<std::uint32_t>(message, kChecksumAt) != checksum(message))
    return Error{Errc::kMalformed, "the checksum of a record differs", {}, kChecksumAt, {}};
  return Record{static_cast<RecordKind>(load_le<std::uint8_t>(message, kKindAt)),
                load_le<std::uint32_t>(message, kSequenceAt), message.subspan(Record::kHeaderBytes)};
}

}  // namespace cairn::clients
