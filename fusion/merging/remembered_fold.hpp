// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/merging/fold.hpp"

namespace cairn::merging {

/// fold() that remembers its results for two opinions. Maps have few different log-odds, so the same pairs come often.
class RememberedFold {
 public:
  RememberedFold(Policy policy, const Limits& limits) : policy_(policy), limits_(limits) {}

  [[nodiscard]] float operator()(std::span<const float> opinions) {
    if (opinions.size() != 2) return fold(policy_, opinions, limits_);
    const auto bits = [&](std::size_t i) { return std::bit_cast<std::uint32_t>(opinions[i]); };
    Memo& memo = memos_[(bits(0) * 0x9E3779B1U + bits(1) * 0x85EBCA77U) >> (32 - kMemoBits)];
    if (bits(0) != memo.first || bits(1) != memo.second) memo = {bits(0), bits(1), fold(policy_, opinions, limits_)};
    return memo.fused;
  }

 private:
  struct Memo {
    std::uint32_t first = 0, second = 0;
    float fused = 0;  // right for two opinions of zero, too
  };
  static constexpr unsigned kMemoBits = 12;

  Policy policy_;
  Limits limits_;
  std::vector<Memo> memos_ = std::vector<Memo>(std::size_t{1} << kMemoBits);
};

}  // namespace cairn::merging
