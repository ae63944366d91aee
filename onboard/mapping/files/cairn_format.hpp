// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/sensor_model.hpp"

// Header, chunk table and checksums of a .cairn file; cairn_file.hpp describes the layout.
namespace cairn::mapping::cairn_format {

inline constexpr std::string_view kMagic = "CAIRNMAP";
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::uint32_t kMaxMetadataBytes = 1U << 16;
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;        ///< the writer closes a chunk at this raw size
inline constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 20;     ///< the reader refuses more
inline constexpr double kMinResolution = 1e-4, kMaxResolution = 100.0;  ///< m; the reader refuses others

/// Size and hash of one compressed chunk.
struct Chunk {
  std::uint32_t raw_bytes = 0;
  std::uint32_t stored_bytes = 0;
  std::uint64_t hash = 0;
};

/// What each leaf has after its log-odds; the value is its size in bytes.
enum class LeafLabel : std::uint8_t {
  kNone = 0,
  kCode = 1,      ///< a VoxelLabel
  kEvidence = 4,  ///< SemanticNode::label_id(), LabelEvidence among them
};

/// The header of a .cairn file.
struct Header {
  double resolution = 0.0;
  SensorModel sensor_model{};
  std::uint64_t nodes = 0;
  std::string_view metadata;
  std::vector<Chunk> chunks;
  std::size_t bytes = 0;  ///< of the header itself; the first chunk starts there
  LeafLabel label = LeafLabel::kNone;
};

/// XXH3-64.
[[nodiscard]] std::uint64_t hash(std::span<const std::byte> bytes);

/// A whole file from its parts. `stored` are the chunks' zstd frames, one after the other.
[[nodiscard]] std::vector<std::byte> assemble(const Header& header, std::span<const std::byte> stored);

/// Checks everything but what is inside the chunks: sizes, header, all checksums. `metadata` points
/// into `bytes`.
Result<Header> parse(std::span<const std::byte> bytes);

}  // namespace cairn::mapping::cairn_format
