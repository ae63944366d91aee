// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::protocol {

// Chapter 6 of the book: two robots among people, by day and by night, at three times.

inline constexpr std::array kLights{"day", "night"};
inline constexpr std::array kPhases{"beginning", "middle", "final"};

// Who is left out of the maps.

inline constexpr const char* kNobody = "nobody";
inline constexpr const char* kByVisible = "visible";  ///< whom the colour camera shows
inline constexpr const char* kByBoth = "both";        ///< whom the colour and the thermal camera show
inline constexpr std::array kPipelines{kNobody, kByVisible, kByBoth};

/// One pair of maps of a mission, beside pair.json: what the maps cost and where they lie.
struct Mission {
  std::string light, pipeline, phase;
  double seconds = 0;              ///< since the mission began
  std::uint64_t raw_bytes = 0;     ///< of LiDAR and cameras as recorded so far, of the robot that has more
  std::uint64_t map_bytes = 0;     ///< of map.cairn, of the robot that has more
  std::uint64_t states_bytes = 0;  ///< told to one teammate about people so far, of the robot that has more
  SE3 T_world_a;                   ///< the frame of robot 1's map in that of the true map
  std::filesystem::path world;     ///< the true map, without people
};

/// The folder of its pair: "night_both_final".
[[nodiscard]] std::string name_of(const Mission& mission);

[[nodiscard]] Result<void> save_mission(const Mission& mission, const std::filesystem::path& file);
/// Errors: those of the disk; kMalformed.
[[nodiscard]] Result<Mission> load_mission(const std::filesystem::path& file);

}  // namespace cairn::protocol
