// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/huge_pages.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace cairn::odometry {
namespace {

constexpr std::size_t kPage = std::size_t{2} << 20;

struct alignas(64) Line {
  int value = 0;
};

std::uintptr_t place_of(const void* memory) { return reinterpret_cast<std::uintptr_t>(memory); }

/// What the kernel says about the memory at this address: the flags of its mapping, proc(5).
std::string flags_of(const void* memory) {
  std::ifstream maps("/proc/self/smaps");
  bool here = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    if (std::istringstream range(line); range >> std::hex >> begin >> dash >> end && dash == '-')
      here = begin <= place_of(memory) && place_of(memory) < end;
    if (here && line.starts_with("VmFlags:")) return line + ' ';
  }
  return {};
}

/// Whether this system notes the wish at all. An emulated processor may not.
bool system_notes_it() {
  void* memory = ::mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return false;
  const bool noted = ::madvise(memory, kPage, MADV_HUGEPAGE) == 0 && flags_of(memory).find(" hg ") != std::string::npos;
  ::munmap(memory, kPage);
  return noted;
}

TEST(HugePageVector, ALargeTableAsksForHugePages) {
  if (!system_notes_it()) GTEST_SKIP() << "this system has no huge pages";
  const HugePageVector<std::uint64_t> table(kPage / 4);
  EXPECT_EQ(place_of(table.data()) % kPage, 0U);
  EXPECT_NE(flags_of(table.data()).find(" hg "), std::string::npos) << flags_of(table.data());
  EXPECT_NE(flags_of(&table.back()).find(" hg "), std::string::npos) << "up to its end";
}

TEST(HugePageVector, ASmallTableLiesWhereItsElementsMay) {
  const HugePageVector<Line> lines(3);
  EXPECT_EQ(place_of(lines.data()) % alignof(Line), 0U);
}

TEST(HugePageVector, GrowsAndMovesAsAnyVector) {
  HugePageVector<Line> lines;  // across the size from which pages are huge
  for (int i = 0; i < 100'000; ++i) lines.push_back({i});
  const HugePageVector<Line> moved = std::move(lines);
  for (int i = 0; i < 100'000; ++i) ASSERT_EQ(moved[static_cast<std::size_t>(i)].value, i);
}

TEST(HugePageVector, RefusesWhatNoMemoryHolds) {
  HugePageAllocator<Line> allocator;
  EXPECT_THROW((void)allocator.allocate(SIZE_MAX / 64), std::bad_array_new_length);
}

}  // namespace
}  // namespace cairn::odometry
