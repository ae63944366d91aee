// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "hal/ports.hpp"
#include "hal/time.hpp"
#include "onboard/app/perception/picture_reader.hpp"
#include "onboard/perception/people/people.hpp"

namespace cairn::app {

/// What a detection task looks at pictures with.
struct DetectionParts {
  people::Eye eye = people::Eye::kVisible;
  std::string source;  ///< id of the camera in the recording
  std::unique_ptr<PictureReader> reader;
  std::unique_ptr<Detector> detector;
  Duration period{};  ///< at least so long from one picture to the next
};

}  // namespace cairn::app
