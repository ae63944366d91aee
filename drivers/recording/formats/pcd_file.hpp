// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// Point clouds as PCL stores them, .PCD version 0.7:
// https://pointclouds.org/documentation/tutorials/pcd_file_format.html
namespace cairn::recording {

/// One column of a PCD file.
struct PcdField {
  std::string name;
  char type = 'F';         ///< 'F' float, 'I' signed, 'U' unsigned
  std::size_t size = 4;    ///< bytes of one value: 1, 2, 4 or 8 (floats: 4 or 8)
  std::size_t count = 1;   ///< values of this column per point
  std::size_t offset = 0;  ///< of the column in a point's bytes (binary)
};

/// The header of a PCD file.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t point_bytes = 0;  ///< of one point (binary)
  bool ascii = false;
  std::size_t data_offset = 0;  ///< where the points begin in the file

  /// The column of this name; null if there is none.
  [[nodiscard]] const PcdField* field(std::string_view name) const;
};

/// The points of a PCD file.
struct PcdCloud {
  PointCloud cloud;                          ///< offsets count from the earliest point; ring 0 where there is none
  bool has_time = false;                     ///< there was a field time, t or timestamp
  std::optional<std::int64_t> end_utc_ns{};  ///< time of the latest point, where the file has absolute times
  std::uint64_t rejected = 0;                ///< points that are not finite or farther away than 10 km
};

inline constexpr std::size_t kMaxPcdBytes = std::size_t{256} << 20U;

/// Reads only the header. Every size in it is checked against the bytes of the file. Errors: kMalformed, kTruncated,
/// kUnsupported, kLimit.
[[nodiscard]] Result<PcdHeader> parse_pcd_header(std::span<const std::byte> file, std::string_view name);

/// Reads fields x y z, and where present intensity (or reflectivity), ring, and time (float seconds), t (integer
/// nanoseconds or float seconds) or timestamp (float seconds). `ascii` and `binary`; `binary_compressed` is refused.
[[nodiscard]] Result<PcdCloud> parse_pcd(std::span<const std::byte> file, std::string_view name);

/// Binary PCD with x y z intensity ring time return_type; time in seconds since the first firing.
[[nodiscard]] std::vector<std::byte> to_pcd(const PointCloud& cloud);

/// Binary PCD of floats. `values`: those of the first point in the order of `fields`, then those of the next.
[[nodiscard]] std::vector<std::byte> to_pcd(std::span<const std::string_view> fields, std::span<const float> values);

}  // namespace cairn::recording
