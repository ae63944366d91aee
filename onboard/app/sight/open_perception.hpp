// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "drivers/recording/formats/recording.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "onboard/app/perception/picture_reader.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// What the perception task looks at pictures with.
struct PerceptionParts {
  std::unique_ptr<PictureReader> reader;  ///< never answers null
  std::unique_ptr<Segmenter> segmenter;
  Duration period{};  ///< at least so long from one labelled picture to the next
};

/// All that a run needs to label its map: what looks at pictures, and where the camera is.
struct Perception {
  PerceptionParts parts;
  std::optional<LabellingSetup> labelling;  ///< none: nothing is labelled
  [[nodiscard]] bool on() const { return labelling.has_value(); }
};

/// Whether a run with these options uses the colour camera of the profile, so that a live run must open it.
[[nodiscard]] bool wants_camera(const RunOptions& options, const RobotProfile& profile);

/// Opens the networks of the profile, or what the recording has in their place. `profile_file`: models are looked for
/// beside it. Where the camera, its calibration or the model's file is missing, that is an event and the result is
/// off: geometry goes on. Errors: a model that is there and does not fit; `--networks recorded` of a recording without
/// labels (kNotFound).
[[nodiscard]] Result<Perception> open_perception(const RunOptions& options, const RobotProfile& profile,
                                                 const std::filesystem::path& profile_file,
                                                 std::span<const recording::SourceEntry> sources, Monitor& monitor);

}  // namespace cairn::app
