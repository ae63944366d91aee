// SPDX-License-Identifier: Apache-2.0
// Which tiles of a team's map have changed: a copy that follows them is the map.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "fusion/merging/team_map.hpp"

namespace cairn::merging {
namespace {

constexpr double kFollowedResolution_m = 0.2;

/// A copy of the map that is shown, from its changed tiles alone.
class Follower {
 public:
  void follow(TeamMap& map) {
    for (const mapping::TileKey tile : map.take_changed_tiles())
      mapping::write_tile(copy_, tile, mapping::read_tile(map.map(), tile));
  }
  void expect_same(const TeamMap& map) const {
    const auto known = mapping::known_tiles(map.map(), std::numeric_limits<std::size_t>::max());
    EXPECT_EQ(known, mapping::known_tiles(copy_, std::numeric_limits<std::size_t>::max()));
    for (const mapping::TileKey tile : known)
      EXPECT_EQ(mapping::read_tile(map.map(), tile), mapping::read_tile(copy_, tile));
  }

 private:
  mapping::SemanticOcTree copy_{kFollowedResolution_m};
};

mapping::TileState some_wall(std::mt19937& random) {
  mapping::TileState state;
  for (unsigned i = 0; i < 20; ++i)
    state.set(random() % 8, random() % 8, random() % 8, random() % 2 == 0 ? 3.5F : -1.6F);
  return state;
}

void put_some(TeamMap& map, std::uint64_t robot, std::mt19937& random) {
  for (int i = 0; i < 30; ++i) {
    const auto at = [&] { return static_cast<std::uint16_t>(32768 + 8 * (random() % 6)); };
    map.put({robot, 0}, mapping::TileKey::of_voxel(at(), at(), at()), some_wall(random), {});
  }
}

TEST(TeamMapChanges, ACopyThatFollowsThemIsTheMap) {
  TeamMap map(kFollowedResolution_m, Policy::kRelativeEntropy);
  map.note_changes();
  Follower follower;
  std::mt19937 random(1);
  for (int round = 0; round < 12; ++round) {
    put_some(map, 1 + random() % 2, random);
    SubmapPoses poses{{{1, 0}, SE3()}};
    if (round % 3 == 1)
      poses[{2, 0}] = SE3::from_xyz_rpy((Vector6() << 0.4 * round, 1, 0, 0, 0, 0.1 * round).finished());
    if (round == 9) map.drop(1);
    map.place(poses);
    for (bool done = false; !done; follower.follow(map)) {
      Budget few = Budget::steps(7);
      done = map.fuse(few);
    }
    follower.expect_same(map);
  }
}

TEST(TeamMapChanges, NobodyNotesThemUnasked) {
  TeamMap map(kFollowedResolution_m, Policy::kRelativeEntropy);
  std::mt19937 random(1);
  put_some(map, 1, random);
  map.place({{{1, 0}, SE3()}});
  Budget all = Budget::steps(100'000);
  EXPECT_TRUE(map.fuse(all));
  EXPECT_TRUE(map.take_changed_tiles().empty());
}

}  // namespace
}  // namespace cairn::merging
