// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/image.hpp"

namespace cairn::thermal {

/// Spreads counts over 8 bits. The counts at two percentiles become 0 and 255, and values outside are clamped.
class Stretch {
 public:
  /// Shares in 0…1, low < high.
  Stretch(double low, double high) : low_(low), high_(high), fine_(kCoarse * kFine) {}

  /// `counts` is kMono16. `out` becomes kMono8 of the same size. A smaller span than `min_span` counts is widened
  /// around its middle, so that noise does not become a picture.
  void apply(const ImageView& counts, double min_span, Image& out);

 private:
  void count(const ImageView& counts);
  [[nodiscard]] double percentile(double share, std::size_t pixels) const;

  double low_, high_;
  // Counts per value, and per kFine values so that a percentile is found in 512 steps.
  static constexpr std::size_t kCoarse = 256, kFine = 256;
  std::array<std::uint32_t, kCoarse> coarse_{};
  std::vector<std::uint32_t> fine_;
};

}  // namespace cairn::thermal
