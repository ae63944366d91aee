// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_pull_command.hpp"

#include <gmock/gmock.h>

#include "onboard/mapping/files/map_file.hpp"
#include "tests/tools/cli/stream/core_stand_in.hpp"
#include "tools/cli/map/map_command.hpp"

namespace cairn::cli {
namespace {

using mapping::TileKey;
using ::testing::HasSubstr;

constexpr std::uint64_t kPulled = 700;

TileKey pulled_key(std::uint64_t i) { return {(std::uint64_t{7} << 36U) + i}; }

void map_once(app::TileOutlet& outlet, int tick) {
  if (tick != 0) return;
  std::vector<TileKey> keys;
  for (std::uint64_t i = 0; i < kPulled; ++i) keys.push_back(pulled_key(i));
  outlet.begin(0);
  outlet.owe(keys);
  outlet.hand_over(kPulled, [](app::TileNews& news) {
    news.state = {};
    news.state.set(1, 2, 3, 3.5F);
  });
}

Outcome pull(std::vector<std::string> arguments, bool team) {
  arguments.insert(arguments.begin(), {"map", "pull"});
  return test::run_beside_core(add_map_command, std::move(arguments), [team](app::StreamOutlets& outlets, int tick) {
    map_once(team ? outlets.team : outlets.own, tick);
  });
}

TEST(MapPull, SavesTheMapOfARunningCore) {
  const TemporaryFolder folder;
  for (const bool team : {false, true})
    for (const std::string name : {"map.cairn", "map.ot", "map.bt"}) {
      const std::string file = (folder / name).string();
      std::vector<std::string> arguments{"--out", file, "--json"};
      if (team) arguments.emplace_back("--team");
      const Outcome o = pull(arguments, team);
      ASSERT_EQ(o.exit_code, app::kDone) << o.err;
      EXPECT_EQ(o.json()["tiles"], kPulled);
      EXPECT_EQ(o.json()["robot"], "husky");
      EXPECT_EQ(o.json()["map"], team ? "team" : "own");
      const auto map = mapping::load_map(file);
      ASSERT_TRUE(map) << to_string(map.error());
      EXPECT_EQ(mapping::known_tiles(**map, 10'000).size(), kPulled);
      EXPECT_GT(mapping::read_tile(**map, pulled_key(99)).log_odds(1, 2, 3), 0);
    }
}

TEST(MapPull, SaysThatThereIsNoMap) {
  const TemporaryFolder folder;
  const Outcome o = pull({"--out", (folder / "map.cairn").string(), "--team"}, false);
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no map of its team"));
  EXPECT_FALSE(std::filesystem::exists(folder / "map.cairn"));
}

TEST(MapPull, RefusesANameThatIsNoMapsFirst) {
  const Outcome o = run(add_map_command, {"map", "pull", "--out", "map.png", "--socket", "nowhere"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr(".cairn"));
}

TEST(MapPull, WithoutACoreItSaysSo) {
  const TemporaryFolder folder;
  const Outcome o = run(add_map_command, {"map", "pull", "--out", (folder / "m.cairn").string(), "--socket",
                                          (folder / "robot.sock").string()});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no core serves this socket"));
}

}  // namespace
}  // namespace cairn::cli
