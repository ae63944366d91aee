// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/stuck.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::safety {
namespace {

using Bytes = std::vector<std::byte>;

Bytes packet(int content) { return Bytes(100, static_cast<std::byte>(content)); }

TEST(StuckWatch, TheThirdOfTheSameIsStuckUntilAnotherOneComes) {
  StuckWatch watch;
  EXPECT_FALSE(watch.step(1, packet(7)));
  EXPECT_FALSE(watch.step(1, packet(7))) << "a duplicate";
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(watch.step(1, packet(7)));
  EXPECT_FALSE(watch.step(1, packet(8)));
  EXPECT_FALSE(watch.step(1, packet(7))) << "what was sent before, but not now";
}

TEST(StuckWatch, TheSecondOfTheSameRepeats) {
  StuckWatch watch;
  (void)watch.step(1, packet(7));
  EXPECT_FALSE(watch.repeats());
  (void)watch.step(1, packet(7));
  EXPECT_TRUE(watch.repeats());
  (void)watch.step(1, packet(8));
  EXPECT_FALSE(watch.repeats());
}

TEST(PictureSample, IsSmallAndSeesEveryPart) {
  PictureSample sample;
  Bytes picture(500'000);
  const auto before = sample.of(picture);
  EXPECT_EQ(before.size(), PictureSample::kMostBytes);
  const Bytes kept(before.begin(), before.end());
  std::fill(picture.begin() + 400'000, picture.begin() + 401'000, std::byte{1});
  const auto after = sample.of(picture);
  EXPECT_FALSE(std::equal(kept.begin(), kept.end(), after.begin()));
  EXPECT_EQ(sample.of(packet(7)).size(), 100U) << "small pictures are compared whole";
}

TEST(StuckWatch, AShorterPacketIsAnother) {
  StuckWatch watch;
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(watch.step(1, Bytes(static_cast<std::size_t>(i % 2)))) << i;
  for (int i = 0; i < 2; ++i) (void)watch.step(1, {});
  EXPECT_TRUE(watch.stuck()) << "three empty ones are the same";
}

TEST(StuckWatch, ChannelsAreStuckEachByItself) {
  StuckWatch watch;
  bool stuck = false;
  for (int i = 0; i < 9; ++i) {
    (void)watch.step(1, packet(i));
    stuck = watch.step(2, packet(0));
    EXPECT_EQ(stuck, i >= 2) << "packets of other channels between do not matter";
  }
  EXPECT_FALSE(watch.step(2, packet(1)));
}

TEST(StuckWatch, IsBoundedInChannels) {
  StuckWatch watch;
  for (int round = 0; round < 4; ++round)
    for (std::uint16_t channel = 100; channel < 200; ++channel) (void)watch.step(channel, packet(round));
  EXPECT_FALSE(watch.stuck());
}

/// Against the definition: the last three of a channel are the same.
TEST(StuckWatch, AgreesWithTheDefinition) {
  std::mt19937 random(1);
  StuckWatch watch;
  std::array<std::vector<int>, 2> sent;
  for (int i = 0; i < 10'000; ++i) {
    const std::size_t channel = random() % 2;
    auto& list = sent[channel];
    list.push_back(static_cast<int>(random() % 2));
    bool expected = false;
    for (const auto& l : sent)
      expected = expected || (l.size() >= 3 && l.end()[-1] == l.end()[-2] && l.end()[-2] == l.end()[-3]);
    ASSERT_EQ(watch.step(static_cast<std::uint16_t>(channel), packet(list.back())), expected) << i;
  }
}

}  // namespace
}  // namespace cairn::safety
