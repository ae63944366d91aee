// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "hal/labels.hpp"
#include "onboard/perception/networks/config/class_map.hpp"

namespace cairn::networks {

/// One plane per channel → the best channel of each pixel as a trainId, with its softmax probability. `logits` holds
/// channels × height × width numbers for the size of `labels`. Of equal channels the first is taken. A pixel whose
/// best number is not finite gets no class. The result is the same on every machine.
void labels_of_logits(std::span<const float> logits, std::size_t channels, const ClassMap& classes, LabelImage& labels);

}  // namespace cairn::networks
