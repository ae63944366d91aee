// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/generations.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>

#include "hal/files/file.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/failing_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

SavedState state_at(int second) {
  SavedState s;
  s.epoch = 4;
  s.boot = "b";
  s.stamp = Time{std::chrono::seconds(second)};
  s.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << second, 0, 0, 0, 0, 0.01 * second).finished());
  return s;
}

/// A map of its own for each number, small enough to damage every byte of its file.
std::unique_ptr<mapping::SemanticOcTree> map_of(int number) {
  auto map = std::make_unique<mapping::SemanticOcTree>(0.1);
  mapping::scatter_updates(*map, static_cast<unsigned>(number), 6);
  return map;
}

class GenerationsTest : public testing::Test {
 protected:
  Generations open() { return {folder_.path(), *monitor_, disk_}; }
  /// Which of the maps is in the folder; −1: none; −2: one that was never saved.
  int newest() {
    const auto loaded = open().load(Time{});
    if (!loaded) return -1;
    const int number = static_cast<int>(to_seconds(loaded->state.stamp));
    const bool same = mapping::differing_nodes(*loaded->map, *map_of(number)) == 0 &&
                      loaded->state.T_odom_base.mean.translation().x() == number;
    return same ? number : -2;
  }
  Result<void> save(Generations& generations, int number) {
    return generations.save(*map_of(number), state_at(number));
  }
  std::vector<std::byte> bytes_of(const char* file) { return read_file(folder_ / file, 1 << 20).value(); }
  void replace(const char* file, std::span<const std::byte> bytes) {
    std::ofstream out(folder_ / file, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    ASSERT_TRUE(out.flush());
  }

  support::TemporaryFolder folder_;
  std::unique_ptr<Monitor> monitor_ = std::make_unique<Monitor>();
  support::FailingDisk disk_;
};

TEST_F(GenerationsTest, TheNewestOfTwoIsLoadedAndTheOlderReplaced) {
  EXPECT_EQ(newest(), -1);
  auto generations = open();
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(save(generations, i));
    EXPECT_EQ(newest(), i);
  }
  auto again = open();  // the program starts anew
  EXPECT_EQ(again.load(Time{})->state.sequence, 5U);
  ASSERT_TRUE(save(again, 6));
  EXPECT_EQ(newest(), 6);
  fs::remove(folder_ / Generations::kMapFiles[1]);
  EXPECT_EQ(newest(), 5);
  EXPECT_TRUE(monitor_->events().empty()) << "nothing was wrong";
}

TEST_F(GenerationsTest, EveryDamagedByteGivesTheGenerationBeforeWithAnEvent) {
  auto generations = open();
  ASSERT_TRUE(save(generations, 1));
  ASSERT_TRUE(save(generations, 2));
  const auto whole = bytes_of(Generations::kMapFiles[1]);
  std::size_t damaged = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const unsigned flip : {0x01U, 0x80U, 0xffU}) {
      auto bytes = whole;
      bytes[i] ^= static_cast<std::byte>(flip);
      replace(Generations::kMapFiles[1], bytes);
      monitor_ = std::make_unique<Monitor>();
      ASSERT_EQ(newest(), 1) << "byte " << i;
      ASSERT_EQ(monitor_->events().size(), 1U);
      ++damaged;
    }
  std::cout << damaged << " damaged files\n";
}

TEST_F(GenerationsTest, EveryTruncationGivesTheGenerationBeforeOrNone) {
  auto generations = open();
  ASSERT_TRUE(save(generations, 1));
  ASSERT_TRUE(save(generations, 2));
  const auto a = bytes_of(Generations::kMapFiles[0]), b = bytes_of(Generations::kMapFiles[1]);
  for (std::size_t n = 0; n < b.size(); ++n) {
    replace(Generations::kMapFiles[1], std::span(b).first(n));
    ASSERT_EQ(newest(), 1) << n;
  }
  for (std::size_t n = 0; n < a.size(); ++n) {
    replace(Generations::kMapFiles[0], std::span(a).first(n));
    ASSERT_EQ(newest(), -1) << n;
  }
  EXPECT_FALSE(monitor_->events().empty());
}

TEST_F(GenerationsTest, WhateverCallFailsThereIsAWholeGenerationAndTheNextSaveWorks) {
  auto generations = open();
  int number = 1;
  ASSERT_TRUE(save(generations, number));
  int failures = 0;
  for (const int error : {ENOSPC, EIO, EROFS})
    for (const bool stays : {false, true})
      for (int n = 0;; ++n) {
        const int before = newest();
        disk_.fail(n, error, stays);
        const auto saved = save(generations, ++number);
        const bool reached = disk_.calls() > n;
        disk_.heal();
        const int after = newest();
        // Whole, and what was there or what was to come.
        EXPECT_TRUE(after == number || after == before) << "call " << n << ": " << after;
        EXPECT_TRUE(!saved || after == number);
        EXPECT_TRUE(fs::exists(folder_ / Generations::kMapFiles[0]) || fs::exists(folder_ / Generations::kMapFiles[1]));
        ASSERT_TRUE(save(generations, ++number));
        EXPECT_EQ(newest(), number);
        failures += saved ? 0 : 1;
        if (!reached) break;
      }
  EXPECT_GE(failures, 3 * 2 * 5) << "open, write, fsync, rename, open of the folder, fsync of the folder";
  EXPECT_TRUE(monitor_->events().empty());
}

TEST_F(GenerationsTest, TheNewestPoseOfTheSameEpochGoesWithTheMap) {
  auto generations = open();
  ASSERT_TRUE(save(generations, 1));
  ASSERT_TRUE(generations.save_state(state_at(3)));
  EXPECT_EQ(open().load(Time{})->state.stamp, Time{3s});
  EXPECT_EQ(open().load(Time{})->state.sequence, 1U);
  SavedState other = state_at(5);
  other.epoch = 5;
  ASSERT_TRUE(generations.save_state(other));
  EXPECT_EQ(open().load(Time{})->state.stamp, Time{1s}) << "a pose in another map";
  ASSERT_TRUE(save(generations, 7));
  ASSERT_TRUE(generations.save_state(state_at(6)));
  EXPECT_EQ(open().load(Time{})->state.stamp, Time{7s}) << "an older pose";
}

TEST_F(GenerationsTest, ADamagedPoseIsAnEventAndTheMapsOwnIsTaken) {
  auto generations = open();
  ASSERT_TRUE(save(generations, 1));
  ASSERT_TRUE(generations.save_state(state_at(3)));
  const auto whole = bytes_of(Generations::kStateFile);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto bytes = whole;
    bytes[i] ^= std::byte{1};
    replace(Generations::kStateFile, bytes);
    monitor_ = std::make_unique<Monitor>();
    ASSERT_EQ(open().load(Time{})->state.stamp, Time{1s}) << i;
    ASSERT_EQ(monitor_->events().size(), 1U);
  }
  for (std::size_t n = 0; n < whole.size(); ++n) {
    replace(Generations::kStateFile, std::span(whole).first(n));
    ASSERT_EQ(open().load(Time{})->state.stamp, Time{1s}) << n;
  }
}

TEST_F(GenerationsTest, AForeignMapIsNoGeneration) {
  replace(Generations::kMapFiles[0], std::as_bytes(std::span("not a map", 9)));
  EXPECT_EQ(newest(), -1);
  EXPECT_EQ(monitor_->events().size(), 1U);
}

TEST_F(GenerationsTest, WithoutAFolderNothingIsLoadedAndSavingSaysWhy) {
  std::ofstream(folder_ / "file") << "x";
  Generations generations(folder_ / "file" / "below", *monitor_);
  EXPECT_FALSE(generations.load(Time{}));
  EXPECT_FALSE(save(generations, 1));
}

}  // namespace
}  // namespace cairn::app
