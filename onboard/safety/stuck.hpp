// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cairn::safety {

/// Whether a source says the same again and again (Fault::kLidarStuck): noise alone makes two real measurements differ.
/// Pure; keeps the bytes of one packet per channel.
class StuckWatch {
 public:
  /// Identical packets of one channel in a row, until the source counts as stuck.
  static constexpr int kInARow = 3;
  /// Of a source; packets of further ones are not watched.
  static constexpr std::size_t kMaxChannels = 4;

  /// The next packet of the source. Stuck until one differs from its predecessor.
  bool step(std::uint16_t channel, std::span<const std::byte> bytes) {
    auto last = std::find_if(last_.begin(), last_.end(), [&](const Last& l) { return l.channel == channel; });
    if (last == last_.end()) {
      if (last_.size() < kMaxChannels) last_.push_back({channel, 1, {bytes.begin(), bytes.end()}});
      return stuck();
    }
    if (std::equal(bytes.begin(), bytes.end(), last->bytes.begin(), last->bytes.end())) {
      last->times = std::min(last->times + 1, kInARow);
    } else {
      last->times = 1;
      last->bytes.assign(bytes.begin(), bytes.end());
    }
    return stuck();
  }
  [[nodiscard]] bool stuck() const {
    return std::any_of(last_.begin(), last_.end(), [](const Last& l) { return l.times >= kInARow; });
  }

 private:
  struct Last {
    std::uint16_t channel;
    int times;
    std::vector<std::byte> bytes;
  };
  std::vector<Last> last_;
};

}  // namespace cairn::safety
