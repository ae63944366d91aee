// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/labels.hpp"

namespace cairn::networks::test {

/// Labels with all classes and many probabilities.
inline LabelImage sample_labels(int width, int height) {
  LabelImage labels;
  labels.resize(width, height);
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    labels.classes[i] = i % 20 == 19 ? kNoClass : static_cast<std::uint8_t>(i % 20);
    labels.probabilities[i] = static_cast<std::uint8_t>(i * 37);
  }
  return labels;
}

/// A PNG of 2×1 pixels with 8 bits of grey: person, no class.
inline std::vector<std::byte> eight_bit_png() {
  constexpr unsigned char kFile[] = {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
                                     0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
                                     0x00, 0xD1, 0x49, 0x20, 0x56, 0x00, 0x00, 0x00, 0x0B, 0x49, 0x44, 0x41, 0x54, 0x78,
                                     0x9C, 0x63, 0xE0, 0xFE, 0x0F, 0x00, 0x01, 0x18, 0x01, 0x0B, 0xF4, 0x36, 0xF3, 0xA6,
                                     0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
  const auto* bytes = reinterpret_cast<const std::byte*>(kFile);
  return {bytes, bytes + sizeof kFile};
}

}  // namespace cairn::networks::test
