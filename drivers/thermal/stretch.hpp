// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/image.hpp"

namespace cairn::thermal {

/// Spreads counts over 8 bits: the counts at two percentiles become 0 and 255, what lies outside is cut off.
class Stretch {
 public:
  /// Shares in 0…1, low < high.
  Stretch(double low, double high) : low_(low), high_(high), histogram_(65536), table_(65536) {}

  /// `counts` is kMono16, `out` becomes kMono8 of the same size. A span of counts below `min_span` is widened to it
  /// around its middle, so that noise does not become a picture.
  void apply(const ImageView& counts, double min_span, Image& out);

 private:
  void count(const ImageView& counts);
  [[nodiscard]] std::size_t percentile(double share, std::size_t pixels) const;
  void fill_table(double low, double span);

  double low_, high_;
  std::size_t coldest_ = 0, warmest_ = 65535;  // of the last picture: only between them the tables are in use
  std::vector<std::uint32_t> histogram_;
  std::vector<std::uint8_t> table_;
};

}  // namespace cairn::thermal
