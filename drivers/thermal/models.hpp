// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace cairn::thermal {

/// What a thermal camera's 16-bit frames look like.
struct Model {
  std::string_view name;          ///< as in a robot profile
  std::uint32_t width = 0;        ///< pixels; 0: whatever comes
  std::uint32_t height = 0;       ///< pixels of the picture itself
  std::uint32_t rows = 0;         ///< rows that may follow the picture and are no picture
  bool lepton_telemetry = false;  ///< what those rows hold is known (telemetry.hpp)
};

/// Sources: FLIR Lepton Engineering Datasheet (500-0659-00-09); FLIR Boson datasheet; Optris libirimager documentation.
[[nodiscard]] std::span<const Model> models();
/// Null for a name that is not in the table.
[[nodiscard]] const Model* find_model(std::string_view name);

/// How counts become temperatures: °C = per_count · count + offset.
struct Scale {
  double per_count = 0, offset = 0;
};
inline constexpr Scale kCentikelvin{0.01, -273.15};  ///< Lepton, Boson: TLinear, high resolution
inline constexpr Scale kDecikelvin{0.1, -273.15};    ///< Lepton: TLinear, low resolution (low gain)
/// Optris, but only of frames that its own library has calibrated: raw frames from the camera are no temperatures.
inline constexpr Scale kOptris{0.1, -100};

}  // namespace cairn::thermal
