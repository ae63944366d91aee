// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/cli/label/network_figures.hpp"

namespace cairn::cli {

/// What `cairn label` is asked for.
struct LabelOptions {
  std::filesystem::path recording;
  std::filesystem::path config;  ///< profile; empty: the recording's own
  std::filesystem::path out;     ///< empty: only figures
  bool overlay = false, overwrite = false;
  std::function<bool()> stop;  ///< asked after each picture
};

/// What came of it.
struct LabelReport {
  std::optional<NetworkFigures> segmentation, detection, thermal_detection;  ///< of the networks that were run
  std::uint64_t pictures = 0;                                                ///< that were decoded: colour and thermal
  std::uint64_t damaged = 0;                                                 ///< that could not be
  std::vector<std::string> damage;                                           ///< the first ones of them
  std::uint64_t correcting = 0;    ///< thermal pictures left out: taken during a flat-field correction
  std::vector<std::string> notes;  ///< what a user should know, one sentence each
  bool interrupted = false;

  static constexpr std::size_t kMaxDamage = 10;
};

/// Runs the profile's networks over the pictures of a recording: those of the first colour camera (its left eye, where
/// two are side by side) and of the first thermal camera. Errors: those of the recording, the profile and the networks;
/// kInvalidConfig (the profile names no network); kNotFound (no picture for any of the networks).
[[nodiscard]] Result<LabelReport> label_recording(const LabelOptions& options);

}  // namespace cairn::cli
