// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/route.hpp"

namespace cairn::simulator {
namespace {

constexpr Time kFirstStep = Time(std::chrono::seconds(10));

/// A lobby, one robot, six people, half a minute.
class CrowdInLobby : public ::testing::Test {
 protected:
  CrowdInLobby() : world_(std::move(*make_world("lobby"))), plan_(world_) {
    const auto paths = RoutePlanner(world_, plan_, 5).plan(1, 60);
    robots_.push_back(drive(world_, plan_, (*paths)[0], kFirstStep, std::chrono::seconds(30), {}, 5));
  }
  [[nodiscard]] Crowd crowd(int count = 6, std::uint64_t seed = 1, double pause_s = 0) const {
    return {world_, plan_, robots_, {.count = count, .pause_s = pause_s}, seed};
  }

  World world_;
  FloorPlan plan_;
  std::vector<Trajectory> robots_;
};

TEST_F(CrowdInLobby, WalksFreelyAndGetsSomewhere) {
  const Crowd people = crowd();
  for (std::size_t i = 0; i < people.size(); ++i) {
    double walked = 0;
    for (Time t = kFirstStep; t < robots_[0].end(); t += Crowd::kStep) {
      const Stride now = people.stride(i, t), then = people.stride(i, t + Crowd::kStep);
      walked += (then.position - now.position).norm();
      EXPECT_GE(plan_.clearance(now.position), 0.2);
      EXPECT_LE(now.velocity.norm(), Crowd::kFastest + 1e-9);
      EXPECT_LE((then.position - now.position).norm(), Crowd::kFastest * to_seconds(Crowd::kStep) + 1e-9);
      EXPECT_GE((now.position - robots_[0].xyz_rpy(t).head<2>()).norm(), 0.75) << "nobody is run over";
    }
    EXPECT_GT(walked, 30 * Crowd::kSlowest * 0.5);
  }
}

TEST_F(CrowdInLobby, ComesNearTheRobot) {
  const Crowd people = crowd();
  int seconds_near = 0;
  for (Time t = kFirstStep; t < robots_[0].end(); t += std::chrono::seconds(1)) {
    bool near = false;
    for (std::size_t i = 0; i < people.size(); ++i) {
      near = near || (people.stride(i, t).position - robots_[0].xyz_rpy(t).head<2>()).norm() < 6;
    }
    seconds_near += near ? 1 : 0;
  }
  EXPECT_GT(seconds_near, 10);
}

TEST_F(CrowdInLobby, SameSeedSameWalksAndAnotherSeedOthers) {
  EXPECT_EQ(crowd().to_csv(), crowd().to_csv());
  EXPECT_NE(crowd().to_csv(), crowd(6, 2).to_csv());
}

/// The longest time that somebody stood, s.
double longest_stand(const Crowd& people, std::size_t person, Time from, Time to) {
  double longest = 0, stood = 0;
  for (Time t = from; t < to; t += Crowd::kStep) {
    stood = people.stride(person, t).velocity.norm() < 0.02 ? stood + to_seconds(Crowd::kStep) : 0;
    longest = std::max(longest, stood);
  }
  return longest;
}

TEST_F(CrowdInLobby, StandsForTheChosenTimeWhereItArrivesAndGoesOn) {
  constexpr double kPause = 6;
  const Crowd people = crowd(6, 1, kPause);
  const Time end = robots_[0].end();
  int stood = 0, went_on = 0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const double longest = longest_stand(people, i, kFirstStep, end);
    EXPECT_LT(longest, kPause + 0.5);
    if (longest < kPause - 2) continue;
    ++stood;
    went_on += people.stride(i, end).velocity.norm() > 0.3 ? 1 : 0;
  }
  EXPECT_GE(stood, 2);
  EXPECT_GE(went_on, 1);
}

TEST_F(CrowdInLobby, WithoutAPauseNobodyStandsForLong) {
  const Crowd people = crowd();
  for (std::size_t i = 0; i < people.size(); ++i)
    EXPECT_LT(longest_stand(people, i, kFirstStep, robots_[0].end()), 3) << i;
}

TEST_F(CrowdInLobby, CsvSaysWhereEverybodyIs) {
  const Crowd people = crowd(3);
  std::istringstream text(people.to_csv());
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "t,id,x,y,vx,vy");
  std::size_t rows = 0;
  double last = 0;
  for (; std::getline(text, line); ++rows) {
    double t = 0, x = 0, y = 0, vx = 0, vy = 0;
    unsigned id = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%u,%lf,%lf,%lf,%lf", &t, &id, &x, &y, &vx, &vy), 6) << line;
    EXPECT_GE(t, last);
    last = t;
    const Stride s = people.stride(id, Time(from_seconds(t)));
    EXPECT_LT((s.position - Eigen::Vector2d(x, y)).norm(), 1e-4);
    EXPECT_LT((s.velocity - Eigen::Vector2d(vx, vy)).norm(), 1e-4);
  }
  EXPECT_NEAR(static_cast<double>(rows), 3 * 30 * 10, 6);
}

TEST_F(CrowdInLobby, ARayMeetsWhatTheFiguresAre) {
  const Crowd people = crowd();
  const Time t = kFirstStep + std::chrono::milliseconds(7777);
  const auto figures = people.figures(t);
  const Eigen::Vector3d eye = robots_[0].T_world_base(t) * Eigen::Vector3d(0, 0, 0.9);
  int hits = 0;
  for (int i = 0; i < 3600; ++i) {
    for (const double up : {-0.2, -0.05, 0.0, 0.1}) {
      const double angle = i * 2e-3;
      const Ray ray{eye, Eigen::Vector3d(std::cos(angle), std::sin(angle), up).normalized()};
      const auto fast = people.trace(ray, t, 60);
      const auto slow = trace(figures, ray, 60);
      ASSERT_EQ(fast.has_value(), slow.has_value());
      if (!fast) continue;
      ++hits;
      EXPECT_EQ(fast->distance, slow->distance);
      EXPECT_EQ(fast->material, slow->part->material);
    }
  }
  EXPECT_GT(hits, 50);
}

}  // namespace
}  // namespace cairn::simulator
