// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cairn::recording {

/// Kinds of source that a recording may hold.
enum class SensorKind : std::uint8_t {
  kVelodyne,  ///< `file` is a pcap of Velodyne datagrams (lidar.pcap)
  kScans,     ///< `file` lists sweeps without packets (data.csv, scan_file.hpp)
  kCamera,    ///< `file` lists pictures (camera/data.csv, image_folder.hpp)
  kThermal,   ///< the same, 16-bit raw counts
  kDepth,     ///< the same, 16-bit depth
  kDrive,     ///< `file` holds candump's lines (drive.log), stamped in UTC
  kGpio,      ///< `file` is gpio.csv
  kPeers,     ///< `file` is peers.log: what other robots sent
  kCommands,  ///< `file` is commands.log: what came by command.sock
};
using enum SensorKind;

/// One row of the table of sensor kinds.
struct SensorKindRow {
  SensorKind kind{};
  std::string_view name;  ///< in recording.yaml
  bool pictures = false;  ///< its packets are pictures in a folder
};

/// In the order of the enumeration, as every table of one row per kind.
inline constexpr std::array kSensorKinds{
    SensorKindRow{.kind = kVelodyne, .name = "velodyne"},
    SensorKindRow{.kind = kScans, .name = "scans"},
    SensorKindRow{.kind = kCamera, .name = "camera", .pictures = true},
    SensorKindRow{.kind = kThermal, .name = "thermal", .pictures = true},
    SensorKindRow{.kind = kDepth, .name = "depth", .pictures = true},
    SensorKindRow{.kind = kDrive, .name = "drive"},
    SensorKindRow{.kind = kGpio, .name = "gpio"},
    SensorKindRow{.kind = kPeers, .name = "peers"},
    SensorKindRow{.kind = kCommands, .name = "commands"},
};

/// Whether a table has one row per kind, in the order of the enumeration: for a static_assert beside the table.
template <class Row, std::size_t N>
[[nodiscard]] constexpr bool one_row_per_kind(const std::array<Row, N>& table) {
  for (std::size_t i = 0; i < N; ++i)
    if (static_cast<std::size_t>(table[i].kind) != i) return false;
  return N == kSensorKinds.size();
}
static_assert(one_row_per_kind(kSensorKinds));

/// The row of a kind in such a table.
template <class Row, std::size_t N>
[[nodiscard]] constexpr const Row& row_of(SensorKind kind, const std::array<Row, N>& table) {
  return table[static_cast<std::size_t>(kind)];
}

[[nodiscard]] constexpr std::string_view to_string(SensorKind kind) { return row_of(kind, kSensorKinds).name; }
[[nodiscard]] constexpr bool is_picture_kind(SensorKind kind) { return row_of(kind, kSensorKinds).pictures; }

/// The kind of this name; none: there is no such kind.
[[nodiscard]] constexpr std::optional<SensorKind> parse_sensor_kind(std::string_view name) {
  for (const SensorKindRow& row : kSensorKinds)
    if (row.name == name) return row.kind;
  return std::nullopt;
}

/// "velodyne, scans, … or peers": for messages.
[[nodiscard]] std::string list_of_sensor_kinds();

}  // namespace cairn::recording
