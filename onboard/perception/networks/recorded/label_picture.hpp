// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "hal/result.hpp"

namespace cairn::networks {

inline constexpr std::size_t kMaxLabelFileBytes = std::size_t{32} << 20U;
inline constexpr int kMaxLabelSide = 4096;  ///< pixels

/// Reads a PNG with labels: 8-bit grey holds trainIds, each with the probability 255; 16-bit grey holds the trainId in
/// the high byte and the probability in the low one. Fills size, classes and probabilities. Errors: kMalformed,
/// kTruncated, kUnsupported (no PNG, no grey), kLimit.
[[nodiscard]] Result<void> decode_label_picture(std::span<const std::byte> file, LabelImage& labels);

/// The 16-bit form. `file` is replaced. Error kIo.
[[nodiscard]] Result<void> encode_label_picture(const LabelImage& labels, std::vector<std::byte>& file);

}  // namespace cairn::networks
