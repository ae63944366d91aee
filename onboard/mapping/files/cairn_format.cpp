// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/cairn_format.hpp"

#include <xxhash.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "hal/bytes.hpp"

namespace cairn::mapping::cairn_format {
namespace {

constexpr std::size_t kFixedBytes = 72;  // up to the metadata
constexpr std::size_t kChunkEntryBytes = 16;
constexpr std::size_t kHashBytes = 8;
constexpr std::size_t kFileBytesOffset = 16;
constexpr std::uint32_t kCodes = 1, kEvidence = 2;  // of the flags

std::uint32_t flags_of(LeafLabel label) {
  return label == LeafLabel::kCode ? kCodes : label == LeafLabel::kEvidence ? kEvidence : 0;
}

Error fault(Errc code, std::string_view cause, std::uint64_t offset, std::string detail = {}) {
  return {code, cause, {}, offset, std::move(detail)};
}

void append(std::vector<std::byte>& out, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// The numbers at the start of a file, as they are written there.
struct Fixed {
  std::uint32_t version = 0, header_bytes = 0;
  std::uint64_t file_bytes = 0;
  double resolution = 0.0;
  SensorModel model{};
  std::uint32_t metadata_bytes = 0;
  std::uint64_t nodes = 0;
  std::uint32_t chunks = 0, flags = 0;
};

Fixed read_fixed(std::span<const std::byte> bytes) {
  ByteReader in(bytes.subspan(kMagic.size(), kFixedBytes - kMagic.size()));
  Fixed f;
  const auto take = [&in](auto& value) { value = *in.read<std::remove_reference_t<decltype(value)>>(); };
  take(f.version), take(f.header_bytes), take(f.file_bytes), take(f.resolution);
  take(f.model.hit), take(f.model.miss), take(f.model.min), take(f.model.max), take(f.model.occupied);
  take(f.metadata_bytes), take(f.nodes), take(f.chunks), take(f.flags);
  return f;
}

std::optional<Error> check_model(const SensorModel& m) {
  const bool finite = std::isfinite(m.hit) && std::isfinite(m.miss) && std::isfinite(m.min) && std::isfinite(m.max) &&
                      std::isfinite(m.occupied);
  if (finite && m.hit >= 0 && m.miss <= 0 && m.min <= m.max) return std::nullopt;
  return fault(Errc::kMalformed, "the sensor model is senseless", 32);
}

/// Sizes first: what they claim must be there before anything is read or reserved.
std::optional<Error> check_sizes(const Fixed& f, std::size_t file_bytes) {
  if (f.version != kVersion)
    return fault(Errc::kUnsupported, "the format version is not supported", 8, std::to_string(f.version));
  if (f.file_bytes > file_bytes)
    return fault(Errc::kTruncated, "the file is cut short", file_bytes,
                 "it should have " + std::to_string(f.file_bytes) + " bytes");
  if (f.file_bytes < file_bytes) return fault(Errc::kMalformed, "bytes follow the map", f.file_bytes);
  const std::uint64_t header_bytes =
      kFixedBytes + std::uint64_t{f.metadata_bytes} + std::uint64_t{f.chunks} * kChunkEntryBytes + kHashBytes;
  if (f.metadata_bytes > kMaxMetadataBytes || f.header_bytes != header_bytes || header_bytes + kHashBytes > file_bytes)
    return fault(Errc::kMalformed, "the sizes in the header do not fit together", 12);
  return std::nullopt;
}

std::optional<Error> check_hash(std::span<const std::byte> bytes, std::size_t end, std::string_view cause) {
  if (hash(bytes.first(end)) == load_le<std::uint64_t>(bytes, end)) return std::nullopt;
  return fault(Errc::kMalformed, cause, end);
}

/// Reads the chunk table and checks each chunk against it.
std::optional<Error> read_chunks(std::span<const std::byte> bytes, const Fixed& f, Header& header) {
  header.chunks.reserve(f.chunks);
  std::size_t offset = f.header_bytes;
  const std::size_t end = bytes.size() - kHashBytes;
  for (std::size_t i = 0; i < f.chunks; ++i) {
    const std::size_t entry = kFixedBytes + f.metadata_bytes + i * kChunkEntryBytes;
    const Chunk chunk{load_le<std::uint32_t>(bytes, entry), load_le<std::uint32_t>(bytes, entry + 4),
                      load_le<std::uint64_t>(bytes, entry + 8)};
    if (chunk.raw_bytes > kMaxChunkBytes || chunk.stored_bytes > end - offset)
      return fault(Errc::kMalformed, "a chunk claims more bytes than it may", entry);
    if (hash(bytes.subspan(offset, chunk.stored_bytes)) != chunk.hash)
      return fault(Errc::kMalformed, "the checksum of a chunk is wrong", offset);
    offset += chunk.stored_bytes;
    header.chunks.push_back(chunk);
  }
  if (offset != end) return fault(Errc::kMalformed, "the chunks do not fill the file", offset);
  return std::nullopt;
}

}  // namespace

std::uint64_t hash(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::vector<std::byte> assemble(const Header& header, std::span<const std::byte> stored) {
  std::vector<std::byte> out;
  append(out, kMagic);
  append_le(out, kVersion);
  append_le(out, static_cast<std::uint32_t>(kFixedBytes + header.metadata.size() +
                                            header.chunks.size() * kChunkEntryBytes + kHashBytes));
  append_le(out, std::uint64_t{0});  // the file's size, known at the end
  append_le(out, header.resolution);
  const SensorModel& m = header.sensor_model;
  for (const float value : {m.hit, m.miss, m.min, m.max, m.occupied}) append_le(out, value);
  append_le(out, static_cast<std::uint32_t>(header.metadata.size()));
  append_le(out, header.nodes);
  append_le(out, static_cast<std::uint32_t>(header.chunks.size()));
  append_le(out, flags_of(header.label));
  append(out, header.metadata);
  for (const Chunk& chunk : header.chunks) {
    append_le(out, chunk.raw_bytes);
    append_le(out, chunk.stored_bytes);
    append_le(out, chunk.hash);
  }
  const std::uint64_t file_bytes = out.size() + kHashBytes + stored.size() + kHashBytes;
  std::memcpy(out.data() + kFileBytesOffset, &file_bytes, sizeof file_bytes);
  append_le(out, hash(out));
  out.insert(out.end(), stored.begin(), stored.end());
  append_le(out, hash(out));
  return out;
}

Result<Header> parse(std::span<const std::byte> bytes) {
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kMagic.size()));
  if (start != kMagic.substr(0, start.size())) return fault(Errc::kMalformed, "not a .cairn file", 0);
  if (bytes.size() < kFixedBytes + 2 * kHashBytes)
    return fault(Errc::kTruncated, "the file is cut short", bytes.size());
  const Fixed f = read_fixed(bytes);
  if (auto error = check_sizes(f, bytes.size())) return *error;
  if (auto error = check_hash(bytes, f.header_bytes - kHashBytes, "the checksum of the header is wrong")) return *error;
  if (!(f.resolution >= kMinResolution && f.resolution <= kMaxResolution))
    return fault(Errc::kMalformed, "the resolution is senseless", 24, std::to_string(f.resolution) + " m");
  if (auto error = check_model(f.model)) return *error;
  if (f.flags > kEvidence) return fault(Errc::kUnsupported, "a reserved field is in use", 68);
  const LeafLabel label = f.flags == kEvidence ? LeafLabel::kEvidence
                          : f.flags == kCodes  ? LeafLabel::kCode
                                               : LeafLabel::kNone;
  Header header{f.resolution, f.model, f.nodes, {}, {}, f.header_bytes, label};
  header.metadata = {reinterpret_cast<const char*>(bytes.data()) + kFixedBytes, f.metadata_bytes};
  if (auto error = read_chunks(bytes, f, header)) return *error;
  if (auto error = check_hash(bytes, bytes.size() - kHashBytes, "the checksum of the file is wrong")) return *error;
  return header;
}

}  // namespace cairn::mapping::cairn_format
