// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// Imported data sets that have no packets: one file per sweep, little-endian records of float32 x y z intensity
// [+ uint32 offset_ns], listed in data.csv. Points in metres in the sensor frame, intensity 0…255.
namespace cairn::recording {

/// Packet::channel of a sweep's bytes: whether each record ends with its firing time.
enum class ScanLayout : std::uint16_t {
  kXyzi = 0,        ///< 16 bytes: x y z intensity
  kXyziOffset = 1,  ///< 20 bytes: x y z intensity offset_ns (since the start of the sweep)
};
[[nodiscard]] constexpr std::size_t record_bytes(ScanLayout layout) { return layout == ScanLayout::kXyzi ? 16 : 20; }

inline constexpr std::size_t kMaxScanPoints = std::size_t{1} << 21U;
inline constexpr std::size_t kMaxScanBytes = kMaxScanPoints * 20;
inline constexpr std::size_t kMaxIndexBytes = std::size_t{64} << 20U;

/// One line of data.csv.
struct ScanIndexEntry {
  Time stamp{};      ///< end of the sweep on the time line of the recording
  std::string file;  ///< relative to the recording's folder
  ScanLayout layout = ScanLayout::kXyzi;
};

/// Reads data.csv: `stamp_ns,file[,has_offset]`, has_offset 0 or 1; lines starting with `#` are comments. Stamps must
/// increase. Entries before a fault are kept in `entries`; the Error names line and byte offset.
[[nodiscard]] Result<void> parse_scan_index(std::string_view text, std::string_view name,
                                            std::vector<ScanIndexEntry>& entries);
[[nodiscard]] std::string to_csv(const ScanIndexEntry& entry);  ///< one line with its end
inline constexpr std::string_view kScanIndexHeader = "# stamp_ns (end of the sweep),file,has_offset\n";

/// The bytes of one sweep; ring and return type are not kept. kXyziOffset when `with_offset`.
[[nodiscard]] std::vector<std::byte> encode_scan(const PointCloud& cloud, bool with_offset);

/// Bytes of one sweep → Scan; every packet is a whole scan. Points that are not finite, farther away than 10 km or
/// later than 2 s in the sweep are left out and counted. valid.end = arrival, valid.start = arrival − largest offset.
class ScanFileDecoder final : public ScanDecoder {
 public:
  /// `deskewed`: the data is motion-compensated already.
  explicit ScanFileDecoder(bool deskewed) : deskewed_(deskewed) {}

  Result<const Scan*> decode(const Packet& packet) override;
  const Scan* expire(Time) override { return nullptr; }
  const Scan* flush() override { return nullptr; }

  [[nodiscard]] std::uint64_t rejected_points() const { return rejected_points_; }
  [[nodiscard]] std::uint64_t rejected_packets() const { return rejected_packets_; }

 private:
  Result<const Scan*> reject(Errc code, std::string_view cause, const Packet& packet);

  bool deskewed_;
  Scan scan_;
  std::uint64_t rejected_points_ = 0, rejected_packets_ = 0;
};

}  // namespace cairn::recording
