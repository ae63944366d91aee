// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
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
  [[nodiscard]] bool stuck() const { return any_came(kInARow); }
  /// A last packet equals the one before it: it tells nothing new.
  [[nodiscard]] bool repeats() const { return any_came(2); }

 private:
  struct Last {
    std::uint16_t channel;
    int times;
    std::vector<std::byte> bytes;
  };
  [[nodiscard]] bool any_came(int times) const {
    return std::any_of(last_.begin(), last_.end(), [=](const Last& l) { return l.times >= times; });
  }
  std::vector<Last> last_;
};

/// Bytes from all over a picture, few enough to be compared with every picture. Noise makes two real pictures differ in
/// many places.
class PictureSample {
 public:
  static constexpr std::size_t kMostBytes = 4096;

  /// At most kMostBytes, evenly spread; of a small picture all. Valid until the next call.
  std::span<const std::byte> of(std::span<const std::byte> picture) {
    if (picture.size() <= kMostBytes) return picture;
    for (std::size_t i = 0; i < kMostBytes; ++i) bytes_[i] = picture[picture.size() * i / kMostBytes];
    return bytes_;
  }

 private:
  std::array<std::byte, kMostBytes> bytes_{};
};

}  // namespace cairn::safety
