// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/stretch.hpp"

#include <algorithm>
#include <cmath>

#include "hal/bytes.hpp"

namespace cairn::thermal {
namespace {

/// Calls use(count) from the first pixel of the first row to the last.
template <class Use>
void for_each_count(const ImageView& counts, Use use) {
  for (int y = 0; y < counts.height; ++y) {
    const auto row = counts.row(y);
    for (std::size_t at = 0; at < row.size(); at += 2) use(std::size_t{load_le<std::uint16_t>(row, at)});
  }
}

}  // namespace

void Stretch::apply(const ImageView& counts, double min_span, Image& out) {
  out.resize(PixelFormat::kMono8, counts.width, counts.height);
  if (counts.empty()) return;
  count(counts);
  const std::size_t pixels = out.bytes.size();
  const double low = percentile(low_, pixels), high = percentile(high_, pixels);
  const double span = std::max({high - low, min_span, 1.0});
  const double scale = 255 / span, offset = 0.5 - (low + high - span) / 2 * scale;
  std::byte* pixel = out.bytes.data();
  for_each_count(counts, [&](std::size_t c) {
    const double grey = std::clamp(static_cast<double>(c) * scale + offset, 0.0, 255.0);
    *pixel++ = static_cast<std::byte>(static_cast<std::uint8_t>(grey));
  });
}

void Stretch::count(const ImageView& counts) {
  coarse_.fill(0);
  std::fill(fine_.begin(), fine_.end(), 0U);
  for_each_count(counts, [&](std::size_t c) {
    ++coarse_[c / kFine];
    ++fine_[c];
  });
}

/// The smallest count that at least `share` of the pixels do not exceed.
double Stretch::percentile(double share, std::size_t pixels) const {
  auto left = std::max<std::int64_t>(1, std::llround(std::ceil(share * static_cast<double>(pixels))));
  std::size_t bin = 0;
  for (; bin < kCoarse - 1 && coarse_[bin] < left; ++bin) left -= coarse_[bin];
  std::size_t count = bin * kFine;
  for (; count < bin * kFine + kFine - 1 && fine_[count] < left; ++count) left -= fine_[count];
  return static_cast<double>(count);
}

}  // namespace cairn::thermal
