// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/models.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::velodyne {
namespace {

using Table = std::array<double, kBlockChannels>;

constexpr Table kVlp16Elevation{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr Table kVlp16OffsetMm{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                               5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};

constexpr Table kHiResElevation{-10,    0.667, -8.667, 2,     -7.333, 3.333, -6,     4.667,
                                -4.667, 6,     -3.333, 7.333, -2,     8.667, -0.667, 10};
constexpr Table kHiResOffsetMm{7.4, -0.9, 6.5, -1.8, 5.5, -2.7, 4.6, -3.7, 3.7, -4.6, 2.7, -5.5, 1.8, -6.5, 0.9, -7.4};

constexpr Table kHdl32Elevation{-30.67, -9.33,  -29.33, -8,     -28,    -6.67, -26.67, -5.33,  -25.33, -4,     -24,
                                -2.67,  -22.67, -1.33,  -21.33, 0,      -20,   1.33,   -18.67, 2.67,   -17.33, 4,
                                -16,    5.33,   -14.67, 6.67,   -13.33, 8,     -12,    9.33,   -10.67, 10.67};
constexpr Table kHdl32OffsetMm{17.17, 4.76,  16.27, 4.07,  15.40, 3.38,  14.54, 2.70,  13.71, 2.02, 12.89,
                               1.35,  12.09, 0.67,  11.31, 0,     10.54, -0.67, 9.78,  -1.35, 9.04, -2.02,
                               8.30,  -2.70, 7.58,  -3.38, 6.86,  -4.07, 6.15,  -4.76, 5.45,  -5.45};

constexpr Table kVlp32cElevation{-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                                 -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                                 -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                 -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
constexpr Table kVlp32cRotation{-1.4, 4.2, -1.4, 1.4, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -4.2, 1.4,
                                -1.4, 4.2, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4, -1.4, 1.4, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4};
constexpr double kVlp32cFocalDistanceMm = 42.4;

/// The manual gives no offsets for the VLP-32C: all beams leave through one point behind the lens.
Table offsets_from_focal_distance(const Table& elevation_deg, double focal_distance_mm) {
  Table offsets_mm{};
  for (std::size_t c = 0; c < offsets_mm.size(); ++c)
    offsets_mm[c] = focal_distance_mm * std::tan(-elevation_deg[c] * std::numbers::pi / 180.0);
  return offsets_mm;
}

/// Fills the channels; a ring is the rank of its elevation.
Model with_channels(Model model, const Table& elevation_deg, const Table& offset_mm, const Table& rotation_deg = {}) {
  const auto used = std::span(elevation_deg).first(static_cast<std::size_t>(model.channel_count));
  for (std::size_t c = 0; c < used.size(); ++c) {
    const auto lower = std::count_if(used.begin(), used.end(), [&](double e) { return e < used[c]; });
    model.channels[c] = {used[c], offset_mm[c] * 1e-3, rotation_deg[c], static_cast<std::uint8_t>(lower)};
  }
  return model;
}

std::array<Model, 4> make_models() {
  constexpr Duration k16Sequence{55'296}, k16Slot{2'304}, kHdlSequence{46'080}, kHdlSlot{1'152};
  return {with_channels({"VLP-16", "Puck", 0x22, 0.002, 16, k16Sequence, k16Slot}, kVlp16Elevation, kVlp16OffsetMm),
          with_channels({"VLP-16-HiRes", "Puck Hi-Res", 0x24, 0.002, 16, k16Sequence, k16Slot}, kHiResElevation,
                        kHiResOffsetMm),
          with_channels({"HDL-32E", "", 0x21, 0.002, 32, kHdlSequence, kHdlSlot, 1, false}, kHdl32Elevation,
                        kHdl32OffsetMm),
          with_channels({"VLP-32C", "Ultra Puck", 0x28, 0.004, 32, k16Sequence, k16Slot, 2}, kVlp32cElevation,
                        offsets_from_focal_distance(kVlp32cElevation, kVlp32cFocalDistanceMm), kVlp32cRotation)};
}

}  // namespace

std::span<const Model> models() {
  static const std::array<Model, 4> all = make_models();
  return all;
}

const Model* find_model(std::string_view name) {
  if (name.empty()) return nullptr;
  const auto all = models();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Model& m) { return m.name == name || m.alias == name; });
  return found == all.end() ? nullptr : &*found;
}

const Model* find_model(std::uint8_t product) {
  const auto all = models();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Model& m) { return m.product == product; });
  return found == all.end() ? nullptr : &*found;
}

std::string model_names() {
  std::string names;
  for (const Model& m : models()) names += (names.empty() ? "" : ", ") + std::string(m.name);
  return names;
}

}  // namespace cairn::velodyne
