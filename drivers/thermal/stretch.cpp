// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/stretch.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::thermal {

void Stretch::apply(const ImageView& counts, double min_span, Image& out) {
  out.resize(PixelFormat::kMono8, counts.width, counts.height);
  if (counts.empty()) return;
  count(counts);
  const std::size_t pixels = out.bytes.size();
  const auto low = static_cast<double>(percentile(low_, pixels)), high = static_cast<double>(percentile(high_, pixels));
  const double span = std::max({high - low, min_span, 1.0});
  fill_table((low + high - span) / 2, span);
  for (int y = 0; y < counts.height; ++y)
    for (int x = 0; x < counts.width; ++x)
      out.bytes[static_cast<std::size_t>(y) * out.stride + static_cast<std::size_t>(x)] =
          std::byte{table_[counts.at<std::uint16_t>(x, y)]};
}

void Stretch::count(const ImageView& counts) {
  std::fill(histogram_.begin() + static_cast<std::ptrdiff_t>(coldest_),
            histogram_.begin() + static_cast<std::ptrdiff_t>(warmest_ + 1), 0U);
  coldest_ = 65535;
  warmest_ = 0;
  for (int y = 0; y < counts.height; ++y)
    for (int x = 0; x < counts.width; ++x) {
      const std::size_t c = counts.at<std::uint16_t>(x, y);
      ++histogram_[c];
      coldest_ = std::min(coldest_, c);
      warmest_ = std::max(warmest_, c);
    }
}

/// The smallest count that at least `share` of the pixels do not exceed.
std::size_t Stretch::percentile(double share, std::size_t pixels) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(pixels)));
  std::uint64_t below = 0;
  for (std::size_t c = coldest_; c < warmest_; ++c) {
    below += histogram_[c];
    if (below >= std::max<std::uint64_t>(wanted, 1)) return c;
  }
  return warmest_;
}

void Stretch::fill_table(double low, double span) {
  for (std::size_t c = coldest_; c <= warmest_; ++c)
    table_[c] = static_cast<std::uint8_t>(std::clamp((static_cast<double>(c) - low) * 255 / span + 0.5, 0.0, 255.0));
}

}  // namespace cairn::thermal
