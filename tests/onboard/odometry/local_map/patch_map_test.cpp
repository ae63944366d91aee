// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kEdge = 0.5;
constexpr float kGate = 0.3F;

constexpr std::size_t kMaxPoints = 400;

PatchMap::Config config(int max_blocks = 1 << 14) { return {kEdge, max_blocks, static_cast<int>(kMaxPoints), {}}; }

/// Every point is kept, blocks are found by division, patches are fitted when asked for. Knows one insertion only.
class SlowMap {
 public:
  SlowMap(const Points& points, const PatchGrid::Sensor& sensor) : sensor_(sensor) {
    for (int g = 0; g < 6; ++g)
      for (const Eigen::Vector3d& p : points)
        if (edge(g) == 4 * kEdge || (sensor.position - p).norm() < 40 * edge(g)) add(blocks_[key(g, p)], p);
  }

  [[nodiscard]] PatchMatch match(const Eigen::Vector3d& p, float gate) const {
    PatchMatch best;
    for (int level = 2; level >= 0; --level) {
      for (const int g : {2 * level, 2 * level + 1}) {
        const PatchMatch m = match_in(g, p, gate);
        if (rank(m) < rank(best)) best = m;
      }
      if (best.kind == PatchMatch::Kind::kOn && best.rows == 1 && best.row[0].variance < 4e-4F) break;
    }
    return best;
  }
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  [[nodiscard]] std::size_t blocks_within(const Eigen::Vector3d& centre, double radius) const {
    std::size_t n = 0;
    for (const auto& [k, points] : blocks_) n += (centre_of(k) - centre).norm() <= radius ? 1 : 0;
    return n;
  }
  [[nodiscard]] std::size_t patches() const {
    std::size_t n = 0;
    for (const auto& [k, points] : blocks_) n += fit(k).kind != Patch::Kind::kNone ? 1 : 0;
    return n;
  }

 private:
  using Key = std::array<int, 4>;
  static void add(Points& block, const Eigen::Vector3d& p) {
    if (block.size() < kMaxPoints) block.push_back(p);
  }
  static double edge(int g) { return kEdge * (1 << (g / 2)); }
  static double shift(int g) { return g % 2 == 0 ? 0.0 : 0.5; }
  static Key key(int g, const Eigen::Vector3d& p) {
    const Eigen::Vector3d i = (p / edge(g)).array() + shift(g);
    return {g, static_cast<int>(std::floor(i.x())), static_cast<int>(std::floor(i.y())),
            static_cast<int>(std::floor(i.z()))};
  }
  static Eigen::Vector3d centre_of(const Key& k) {
    return edge(k[0]) * (Eigen::Vector3d(k[1], k[2], k[3]).array() + 0.5 - shift(k[0]));
  }
  [[nodiscard]] Patch fit(const Key& k) const {
    Moments m;
    for (const Eigen::Vector3d& p : blocks_.at(k)) m.add((p - centre_of(k)).cast<float>(), 0);
    return fit_patch(m, static_cast<float>(edge(k[0])), {},
                     {(sensor_.position - centre_of(k)).cast<float>(), sensor_.up});
  }
  [[nodiscard]] PatchMatch match_in(int g, const Eigen::Vector3d& p, float gate) const {
    PatchMatch m;
    const Key k = key(g, p);
    const Patch patch = blocks_.contains(k) ? fit(k) : Patch{};
    if (patch.kind == Patch::Kind::kNone) return m;
    const Eigen::Vector3f d = (p - centre_of(k)).cast<float>() - patch.centroid;
    m.rows = patch.kind == Patch::Kind::kPole ? 2 : 1;
    float squared = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.rows); ++i) {
      const Patch::Axis& axis = i == 0 ? patch.normal : patch.second;
      m.row[i] = {axis.direction, axis.direction.dot(d), patch.prediction_variance(axis, d.squaredNorm())};
      squared += m.row[i].distance * m.row[i].distance;
    }
    m.kind = squared > gate * gate ? PatchMatch::Kind::kOff : PatchMatch::Kind::kOn;
    return m;
  }
  static std::array<float, 3> rank(const PatchMatch& m) {
    return {-static_cast<float>(m.kind), static_cast<float>(m.rows), m.row[0].variance};
  }

  PatchGrid::Sensor sensor_;
  std::map<Key, Points> blocks_;
};

Eigen::Vector3f towards(const Eigen::Vector3d& p, const PatchGrid::Sensor& sensor) {
  return (sensor.position - p).cast<float>();
}

void expect_equal(const PatchMatch& a, const PatchMatch& b) {
  ASSERT_EQ(a.kind, b.kind);
  ASSERT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.epoch, b.epoch);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i) {
    EXPECT_EQ(a.row[i].direction, b.row[i].direction);
    EXPECT_EQ(a.row[i].distance, b.row[i].distance);
    EXPECT_EQ(a.row[i].variance, b.row[i].variance);
  }
}

void insert(PatchMap& map, const Points& points, float epoch = 0, unsigned threads = 1) {
  Workers workers(threads);
  map.insert(points, Room::sensor(), epoch, workers);
}

void expect_same_answers(const PatchMap& a, const PatchMap& b) {
  EXPECT_EQ(a.blocks(), b.blocks());
  EXPECT_EQ(a.patches(), b.patches());
  for (const Eigen::Vector3d& p : Room(9).points(500, 0.05)) {
    const Eigen::Vector3f to_sensor = towards(p, Room::sensor());
    expect_equal(a.match(p, to_sensor, kGate), b.match(p, to_sensor, kGate));
  }
}

TEST(PatchMap, AnswersAsAMapThatKeepsEveryPoint) {
  const Points points = Room(1).points(12000, 0.01);
  PatchMap map(config());
  insert(map, points);
  const SlowMap slow(points, Room::sensor());
  EXPECT_EQ(map.blocks(), slow.blocks());
  EXPECT_EQ(map.patches(), slow.patches());
  std::array<int, 3> kinds{};
  int poles = 0;
  for (const Eigen::Vector3d& p : Room(2).points(1000, 0.15)) {
    const PatchMatch match = map.match(p, towards(p, Room::sensor()), kGate);
    expect_equal(match, slow.match(p, kGate));
    ++kinds[static_cast<std::size_t>(match.kind)];
    poles += match.rows == 2 ? 1 : 0;
  }
  EXPECT_GT(kinds[1], 10) << "off";
  EXPECT_GT(kinds[2], 500) << "on";
  EXPECT_GT(poles, 5);
}

TEST(PatchMap, FarPointsGoIntoTheCoarseGridsOnly) {
  Points points = Room(1).points(3000, 0.01);
  for (Eigen::Vector3d& p : points) p.x() += 25;
  PatchMap map(config());
  insert(map, points);
  const SlowMap slow(points, Room::sensor());
  EXPECT_EQ(map.blocks(), slow.blocks());
  EXPECT_EQ(map.patches(), slow.patches());
}

TEST(PatchMap, IsTheSameForAnyNumberOfThreads) {
  PatchMap one(config()), many(config());
  for (unsigned round = 0; round < 3; ++round) {
    const Points points = Room(round).points(4000, 0.01);
    insert(one, points, static_cast<float>(round), 1);
    insert(many, points, static_cast<float>(round), 3);
  }
  expect_same_answers(one, many);
}

TEST(PatchMap, OnlyTheOrderOfThePointsCountsNotHowTheyAreParted) {
  const Points once = Room(1).points(6000, 0.01);
  Points twice = once;
  twice.insert(twice.end(), once.begin(), once.end());
  PatchMap whole(config()), parted(config());
  insert(whole, twice);
  insert(parted, once);
  insert(parted, once);  // doubles every block, so all of them are fitted anew
  expect_same_answers(whole, parted);
}

TEST(PatchMap, ForgetsByDistanceAndKeepsTheRestAsItWas) {
  const Points points = Room(1).points(12000, 0.01);
  PatchMap map(config());
  insert(map, points);
  const PatchMap before = map;
  const SlowMap slow(points, Room::sensor());
  const Eigen::Vector3d centre(-2, 1, 0);
  for (const double radius : {6.0, 3.5}) {
    map.keep_within(centre, radius);
    EXPECT_EQ(map.blocks(), slow.blocks_within(centre, radius));
    for (const Eigen::Vector3d& p : Room(2).points(1000, 0.05)) {
      const Eigen::Vector3f to_sensor = towards(p, Room::sensor());
      const double half_diagonal = std::sqrt(3.0) * 2 * kEdge;
      const double distance = (p - centre).norm();
      const PatchMatch match = map.match(p, to_sensor, kGate);
      if (distance < radius - half_diagonal) {
        expect_equal(match, before.match(p, to_sensor, kGate));
      } else if (distance > radius + half_diagonal) {
        EXPECT_EQ(match.kind, PatchMatch::Kind::kNone);
      }
    }
  }
  map.clear();
  EXPECT_EQ(map.blocks(), 0U);
  EXPECT_EQ(map.patches(), 0U);
}

TEST(PatchMap, WhenFullItGivesUpTheFarthestFirst) {
  const Points points = Room(1).points(12000, 0.01);
  PatchMap map(config(400));
  insert(map, points);
  EXPECT_LE(map.blocks(), 2U * (400 + 200 + 200)) << "its bound";
  const std::size_t full = map.blocks();
  map.keep_within(Eigen::Vector3d(-3, -3, 0), 1000.0);
  EXPECT_LT(map.blocks(), full);
  EXPECT_LE(map.blocks(), 2U * (360 + 180 + 180));
  const std::size_t kept = map.blocks();
  map.keep_within(Eigen::Vector3d(-3, -3, 0), 1000.0);
  EXPECT_EQ(map.blocks(), kept) << "a tenth is free now";
}

TEST(PatchMap, AThinWallHasTwoSides) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(-2, 2);
  std::normal_distribution<double> noise(0, 0.005);
  Workers workers(1);
  PatchMap map(config());
  for (const double side : {1.0, -1.0}) {
    Points points;
    for (int i = 0; i < 5000; ++i) points.emplace_back(0.1 + side * 0.05 + noise(random), at(random), at(random));
    map.insert(points, {{3.0 * side, 0.3, 0.2}, {0, 0, 1}}, 0, workers);
  }
  const Eigen::Vector3d inside(0.1, 0.2, 0.3);
  const PatchMatch front = map.match(inside, {1, 0, 0}, kGate), back = map.match(inside, {-1, 0, 0}, kGate);
  ASSERT_EQ(front.kind, PatchMatch::Kind::kOn);
  ASSERT_EQ(back.kind, PatchMatch::Kind::kOn);
  EXPECT_GT(front.row[0].direction.x(), 0.99F);
  EXPECT_LT(back.row[0].direction.x(), -0.99F);
  EXPECT_NEAR(front.row[0].distance, -0.05, 0.005);
  EXPECT_NEAR(back.row[0].distance, -0.05, 0.005);
}

TEST(PatchMap, APatchRemembersWhenItWasMade) {
  PatchMap map(config());
  insert(map, Room(1).points(3000, 0.01), 7);
  const Eigen::Vector3d wall(Room::kLow.x(), 0.1, 0.4);
  EXPECT_EQ(map.match(wall, towards(wall, Room::sensor()), kGate).epoch, 7);
  insert(map, Room(2).points(3000, 0.01), 17);
  EXPECT_NEAR(map.match(wall, towards(wall, Room::sensor()), kGate).epoch, 12, 1);
}

TEST(PatchMap, APatchIsLastingOnceItHasBeenSeenForSoLong) {
  PatchMap::Config wanted = config();
  wanted.lasting_s = 1;
  PatchMap map(wanted);
  Workers workers(1);
  const Eigen::Vector3d old_wall(Room::kLow.x(), 0.1, 0.4), new_wall(Room::kLow.x() + Room::kSize.x(), 0.1, 0.4);
  const Points all = Room(1).points(30000, 0.01);
  Points behind = all;  // without the wall in front
  std::erase_if(behind, [&](const Eigen::Vector3d& p) { return p.x() > new_wall.x() - 0.5; });
  const auto seen_at = [&](const Points& points, float time_s) {
    PatchGrid::Sensor sensor = Room::sensor();
    sensor.time_s = time_s;
    map.insert(points, sensor, 0, workers);
  };
  const auto lasting = [&](const Eigen::Vector3d& wall) {
    const PatchMatch match = map.match(wall, towards(wall, Room::sensor()), kGate);
    EXPECT_EQ(match.kind, PatchMatch::Kind::kOn);
    return match.lasting;
  };
  seen_at(behind, 0);
  EXPECT_TRUE(lasting(old_wall)) << "a young map has nothing better";
  seen_at(behind, 0.9F);
  seen_at(all, 2.5F);
  EXPECT_TRUE(lasting(old_wall));
  EXPECT_FALSE(lasting(new_wall));
  seen_at(all, 3.4F);
  EXPECT_FALSE(lasting(new_wall));
  seen_at(all, 3.5F);
  EXPECT_TRUE(lasting(new_wall)) << "also if the block has taken all the points that it takes";
}

}  // namespace
}  // namespace cairn::odometry
