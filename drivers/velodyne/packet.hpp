// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// Wire layout of Velodyne's 16- and 32-laser sensors; all fields little-endian. Sources: VLP-16 user manual 63-9243,
/// HDL-32E manual 63-9113, VLP-32C manual 63-9325.
namespace cairn::velodyne {

inline constexpr std::uint16_t kDefaultDataPort = 2368;
inline constexpr std::uint16_t kDefaultPositionPort = 8308;

// ---- data packet: 12 blocks, then the tail
inline constexpr std::size_t kDataBytes = 1206;
inline constexpr int kBlocks = 12;
inline constexpr int kBlockChannels = 32;  ///< distance/reflectivity pairs in a block, whatever the sensor
inline constexpr std::size_t kBlockBytes = 100;
inline constexpr std::size_t kBlockFlagOffset = 0;     ///< u16, in the block
inline constexpr std::size_t kBlockAzimuthOffset = 2;  ///< u16, 0.01°, clockwise seen from above
inline constexpr std::size_t kBlockReturnsOffset = 4;  ///< kBlockChannels × {u16 distance, u8 reflectivity}
inline constexpr std::size_t kReturnBytes = 3;
inline constexpr std::size_t kTimestampOffset = 1200;   ///< u32, µs past the hour of the first firing
inline constexpr std::size_t kReturnModeOffset = 1204;  ///< u8, ReturnMode
inline constexpr std::size_t kProductOffset = 1205;     ///< u8, Model::product

inline constexpr std::uint16_t kBlockFlag = 0xEEFF;  ///< on the wire FF EE
inline constexpr int kAzimuthUnits = 36000;          ///< valid azimuths are 0 … 35999
inline constexpr double kAzimuthUnitDeg = 0.01;

/// Byte kReturnModeOffset of a data packet. In dual mode a pair of blocks (0,1), (2,3), … is one firing with one
/// azimuth. The even block holds the last return, the odd block the strongest. If the strongest is also the last, the
/// odd block holds the second strongest. If there was only one return, both are equal.
enum class ReturnMode : std::uint8_t { kStrongest = 0x37, kLast = 0x38, kDual = 0x39 };

inline constexpr std::int64_t kMicrosecondsPerHour = 3'600'000'000;

// ---- position packet
inline constexpr std::size_t kPositionBytes = 512;
inline constexpr std::size_t kTopBoardTemperatureOffset = 0xBB;     ///< i8, °C
inline constexpr std::size_t kBottomBoardTemperatureOffset = 0xBC;  ///< i8, °C
inline constexpr std::size_t kPositionTimestampOffset = 0xC6;       ///< u32, µs past the hour
inline constexpr std::size_t kPpsStateOffset = 0xCA;                ///< u8, PpsState
inline constexpr std::size_t kThermalShutdownOffset = 0xCB;         ///< u8, 0 none
inline constexpr std::size_t kNmeaOffset = 0xCE;                    ///< text, CR LF, NULs
inline constexpr std::size_t kNmeaBytes = 128;

/// Byte kPpsStateOffset of a position packet.
enum class PpsState : std::uint8_t { kAbsent = 0, kSynchronising = 1, kLocked = 2, kError = 3 };

}  // namespace cairn::velodyne
