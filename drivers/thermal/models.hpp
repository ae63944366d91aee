// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace cairn::thermal {

/// The 16-bit frames of one thermal camera.
struct Model {
  std::string_view name;          ///< as in a robot profile
  std::uint32_t width = 0;        ///< pixels; 0: any
  std::uint32_t height = 0;       ///< pixels of the picture, without telemetry
  std::uint32_t rows = 0;         ///< telemetry rows that may follow the picture
  bool lepton_telemetry = false;  ///< those rows are a Lepton's (telemetry.hpp)
};

/// The table of models. Sources: FLIR Lepton Engineering Datasheet (500-0659-00-09), FLIR Boson datasheet, Optris
/// libirimager documentation.
[[nodiscard]] std::span<const Model> models();
/// Null for a name that is not in the table.
[[nodiscard]] const Model* find_model(std::string_view name);

/// How counts become temperatures: °C = per_count · count + offset.
struct Scale {
  double per_count = 0, offset = 0;
};
inline constexpr Scale kCentikelvin{0.01, -273.15};  ///< Lepton, Boson: TLinear, high resolution
inline constexpr Scale kDecikelvin{0.1, -273.15};    ///< Lepton: TLinear, low resolution (low gain)
/// Optris, only for frames that its own library has calibrated. Raw frames of the camera are not temperatures.
inline constexpr Scale kOptris{0.1, -100};

}  // namespace cairn::thermal
