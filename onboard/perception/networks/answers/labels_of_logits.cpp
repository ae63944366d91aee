// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/labels_of_logits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace cairn::networks {
namespace {

// A fixed number of pixels at a time: the compiler then uses vectors.
constexpr std::size_t kBlock = 64;
using Numbers = std::array<float, kBlock>;

/// e^x for x <= 0, with a relative error of 1.1e-4 at most; the same bits on every machine, which std::exp does not
/// promise.
inline float exponential(float x) {
  constexpr float kLog2e = 1.44269504F, kSmallest = -80.0F;
  const float power = (x > kSmallest ? x : kSmallest) * kLog2e;  // of no number, too
  const auto whole = static_cast<std::int32_t>(power) - 1;       // the fraction is then in 0…1
  const float f = power - static_cast<float>(whole);
  // 2^f for f in 0…1: a cubic that meets 1 and 2 at the ends.
  const float two_to_f = 1.0F + f * (0.6954244F + f * (0.2263077F + f * 0.0782679F));
  return two_to_f * std::bit_cast<float>((whole + 127) << 23);
}

struct Block {
  Numbers best{}, sum{};
  std::array<std::int32_t, kBlock> channel{};
};

void find_best(const float* logits, std::size_t channels, std::size_t pixels, Block& block) {
  std::copy_n(logits, kBlock, block.best.begin());
  block.channel.fill(0);
  for (std::size_t c = 1; c < channels; ++c) {
    const float* plane = logits + c * pixels;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const bool better = plane[i] > block.best[i];
      block.best[i] = better ? plane[i] : block.best[i];
      block.channel[i] = better ? static_cast<std::int32_t>(c) : block.channel[i];
    }
  }
}

void add_exponentials(const float* logits, std::size_t channels, std::size_t pixels, Block& block) {
  block.sum.fill(0.0F);
  for (std::size_t c = 0; c < channels; ++c) {
    const float* plane = logits + c * pixels;
    for (std::size_t i = 0; i < kBlock; ++i) block.sum[i] += exponential(plane[i] - block.best[i]);
  }
}

/// In 255ths; 0 where `sum` is no number, which a softmax cannot give.
std::uint8_t share(float sum) {
  const float probability = 255.0F / sum + 0.5F;
  return probability > 0.0F && probability < 256.0F ? static_cast<std::uint8_t>(probability) : std::uint8_t{0};
}

void label_block(const float* logits, std::size_t channels, std::size_t pixels, const ClassMap& classes,
                 std::uint8_t* ids, std::uint8_t* probabilities) {
  Block block;
  find_best(logits, channels, pixels, block);
  add_exponentials(logits, channels, pixels, block);
  for (std::size_t i = 0; i < kBlock; ++i) {
    probabilities[i] = share(block.sum[i]);
    ids[i] = probabilities[i] == 0 ? kNoClass : classes[static_cast<std::size_t>(block.channel[i])];
  }
}

}  // namespace

void labels_of_logits(std::span<const float> logits, std::size_t channels, const ClassMap& classes,
                      LabelImage& labels) {
  const std::size_t pixels = labels.classes.size();
  std::size_t at = 0;
  for (; at + kBlock <= pixels; at += kBlock)
    label_block(logits.data() + at, channels, pixels, classes, labels.classes.data() + at,
                labels.probabilities.data() + at);
  if (at == pixels) return;
  // The rest, in planes of one block.
  const std::size_t rest = pixels - at;
  std::vector<float> padded(channels * kBlock);
  for (std::size_t c = 0; c < channels; ++c)
    std::copy_n(logits.data() + c * pixels + at, rest, padded.data() + c * kBlock);
  std::array<std::uint8_t, kBlock> ids{}, probabilities{};
  label_block(padded.data(), channels, kBlock, classes, ids.data(), probabilities.data());
  std::copy_n(ids.begin(), rest, labels.classes.data() + at);
  std::copy_n(probabilities.begin(), rest, labels.probabilities.data() + at);
}

}  // namespace cairn::networks
