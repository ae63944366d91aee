// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/tile_stream.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "tests/onboard/app/streams/streams_rig.hpp"

namespace cairn::app {
namespace {

using clients::TileMap;
using test::RobotStream;
using test::Stream;
using test::wanted;

class TileStreamTest : public test::StreamsRig {};

TEST_F(TileStreamTest, AMirrorHasEveryTile) {
  RobotStream tiles = connect(wanted({Stream::kOwnTiles}));
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  run();
  take_in(tiles, mirror);
  EXPECT_TRUE(mirror.caught_up());  // with nothing
  map(0, 100, 900);
  run();
  take_in(tiles, mirror);
  EXPECT_TRUE(mirror.caught_up());
  EXPECT_EQ(mirror.tiles(), 900U);
  ASSERT_NE(mirror.origin_of({100}), nullptr);
  EXPECT_THAT(mirror.origin_of({100})->robots, ::testing::ElementsAre(kSelf));
}

TEST_F(TileStreamTest, WhoDoesNotReadMissesNoTile) {
  RobotStream deaf = connect(wanted({Stream::kOwnTiles, Stream::kPose}));
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  for (unsigned round = 0; round < 12; ++round) {
    for (std::uint64_t part = 0; part < 8; ++part) {
      map(0, 2000 * part, 2000, round % 8);
      run();
      locate(static_cast<int>(8 * round + part));
    }
  }
  for (int i = 0; i < 400; ++i) {
    run();
    take_in(deaf, mirror);
  }
  EXPECT_TRUE(mirror.caught_up());
  EXPECT_EQ(mirror.tiles(), 16'000U);
  for (const std::uint64_t key : {0U, 7776U, 15'998U})
    EXPECT_GT(mapping::read_tile(mirror.map(), {key}).log_odds(3, 1, 2), 0) << "round 11 set x = 3";
  EXPECT_EQ(deaf.lost(), 0U) << "tiles leave room for poses";
  for (int i = 0; i < 2000; ++i) {
    locate(i);
    run(1);
  }
  take_in(deaf, mirror);
  locate(0);
  run(1);
  take_in(deaf, mirror);
  EXPECT_GT(deaf.lost(), 0U);
}

/// As robots map: a thousand tiles a second, most of them again and again.
TEST_F(TileStreamTest, AfterThirtySecondsAwayAMirrorHasEveryTileWithinTwo) {
  auto wants = wanted({Stream::kOwnTiles});
  RobotStream always = connect(wants);
  client::MapMirror there(TileMap::kOwn, 0.2), back(TileMap::kOwn, 0.2);
  {
    RobotStream first = connect(wants);
    map(0, 0, 5000);
    run(50);
    take_in(always, there);
    take_in(first, back);
  }
  for (unsigned i = 0; i < 60; ++i) {
    map(0, 300 * i, 500, i % 8);
    run(100);  // half a second
    take_in(always, there);
  }
  wants.own = back.resume();
  RobotStream second = connect(wants);
  const Time before = now_;
  do {
    run(1);
    take_in(second, back);
  } while (!(back.caught_up() && back.tiles() == there.tiles()) && now_ - before < std::chrono::seconds(10));
  RecordProperty("s", std::to_string(to_seconds(now_ - before)));
  EXPECT_LE(now_ - before, std::chrono::seconds(2));
  EXPECT_GT(there.tiles(), 18'000U);
  const auto tiles = mapping::known_tiles(there.map(), 1'000'000);
  ASSERT_EQ(tiles, mapping::known_tiles(back.map(), 1'000'000));
  for (const mapping::TileKey tile : tiles)
    ASSERT_EQ(mapping::read_tile(there.map(), tile), mapping::read_tile(back.map(), tile));
}

TEST_F(TileStreamTest, AMirrorThatComesBackGetsWhatItLacks) {
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  auto wants = wanted({Stream::kOwnTiles});
  {
    RobotStream first = connect(wants);
    map(0, 0, 500);
    run();
    take_in(first, mirror);
  }
  map(0, 490, 20, 5);
  run();
  wants.own = mirror.resume();
  RobotStream second = connect(wants);
  run();
  std::size_t got = 0;
  for (const auto& message : read<clients::TilesMessage>(second)) {
    got += message.tiles.size();
    ASSERT_TRUE(mirror.take(message));
  }
  EXPECT_EQ(got, 20U);
  EXPECT_EQ(mirror.tiles(), 510U);
  EXPECT_TRUE(mirror.caught_up());
}

TEST_F(TileStreamTest, ANewMapVoidsTheMirror) {
  RobotStream tiles = connect(wanted({Stream::kOwnTiles}));
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  map(0, 0, 50);
  run();
  take_in(tiles, mirror);
  map(1, 40, 20);
  run();
  take_in(tiles, mirror);
  EXPECT_EQ(mirror.tiles(), 20U);
  EXPECT_EQ(mirror.resume().epoch, 1U);
}

TEST_F(TileStreamTest, TheLastTilesComeBeforeTheEnd) {
  RobotStream tiles = connect(wanted({Stream::kOwnTiles}));
  run();
  bool asked = false;
  task_.close(LiveClock(), [&] {
    if (!asked) map(0, 0, 30);
    asked = true;
    return true;
  });
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  take_in(tiles, mirror);
  EXPECT_EQ(mirror.tiles(), 30U);
}

/// A look at it takes this long.
class BusyClock final : public Clock {
 public:
  BusyClock(Time begin, Duration look) : now_(begin), look_(look) {}
  [[nodiscard]] Time now() const override { return now_ += look_; }

 private:
  mutable Time now_;
  Duration look_;
};

/// A client has not read for two seconds, so that its socket is tried less and less often. Then it reads.
class TileStreamsEnd : public TileStreamTest, public ::testing::WithParamInterface<Duration> {};

TEST_P(TileStreamsEnd, AReaderGetsAll) {
  RobotStream tiles = connect(wanted({Stream::kOwnTiles}));
  for (unsigned i = 0; i < 20; ++i) {
    map(0, 1000 * i, 1000);
    run(24);  // 120 ms
  }
  client::MapMirror mirror(TileMap::kOwn, 0.2);
  task_.close(BusyClock(now_, GetParam()), [&] {
    take_in(tiles, mirror);
    return true;
  });
  take_in(tiles, mirror);
  EXPECT_EQ(mirror.tiles(), 20'000U);
}

INSTANTIATE_TEST_SUITE_P(Busy, TileStreamsEnd,
                         ::testing::Values(std::chrono::milliseconds(1), std::chrono::seconds(1)));

TEST_F(TileStreamTest, ClientsThatComeAgainAndAgainCannotDrawOutTheEnd) {
  run();
  int attempts = 0;
  std::optional<RobotStream> tiles;
  task_.close(BusyClock(now_, std::chrono::milliseconds(1)), [&] {
    if (attempts % (StreamsTask::kAttempts / 2) == 0) tiles.emplace(connect(wanted({Stream::kOwnTiles})));
    return ++attempts > 2 * StreamsTask::kAllAttempts;
  });
  EXPECT_LE(attempts, StreamsTask::kAllAttempts);
  EXPECT_GT(attempts, 2 * StreamsTask::kAttempts) << "none of them was sent anything";
}

}  // namespace
}  // namespace cairn::app
