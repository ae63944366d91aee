// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_people.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace cairn::app {
namespace {

using ::testing::HasSubstr;

std::vector<recording::SourceEntry> sources(const std::vector<recording::SensorKind>& kinds) {
  std::vector<recording::SourceEntry> list;
  for (const recording::SensorKind kind : kinds) list.emplace_back().kind = kind;
  return list;
}

RobotProfile profile(const std::string& points, double rate_hz) {
  RobotProfile p;
  p.perception.people.follow = "always";
  p.perception.people.points = points;
  p.depth.map.rate_hz = rate_hz;
  return p;
}

TEST(PeopleByDepth, AutoMeansCloudsWhereThereIsNoLidar) {
  const auto flying = sources({recording::kCamera, recording::kDepth});
  const auto driving = sources({recording::kVelodyne, recording::kDepth});
  EXPECT_TRUE(people_by_depth(profile("auto", 5), flying));
  EXPECT_FALSE(people_by_depth(profile("auto", 5), driving));
  EXPECT_FALSE(people_by_depth(profile("auto", 0), flying)) << "the map gets no clouds";
  EXPECT_FALSE(people_by_depth(profile("auto", 5), sources({recording::kCamera})));
}

TEST(PeopleByDepth, TheProfileMayChoose) {
  EXPECT_TRUE(people_by_depth(profile("depth", 5), sources({recording::kVelodyne, recording::kDepth})));
  EXPECT_FALSE(people_by_depth(profile("scans", 5), sources({recording::kCamera, recording::kDepth})));
}

TEST(PeopleByDepth, NobodyIsFollowedWhereTheCloudsAreMissing) {
  for (const auto& [p, kinds] : {std::pair(profile("depth", 0), sources({recording::kVelodyne, recording::kDepth})),
                                 std::pair(profile("depth", 5), sources({recording::kVelodyne}))}) {
    Monitor monitor;
    const auto watch = open_people({}, p, "", kinds, monitor);
    ASSERT_TRUE(watch);
    EXPECT_FALSE(watch->setup);
    ASSERT_EQ(monitor.events().size(), 1U);
    EXPECT_THAT(monitor.events().front().what, HasSubstr("nobody is followed: perception.people.points is depth"));
  }
}

TEST(PeopleByDepth, TheSetupSaysIt) {
  Monitor monitor;
  for (const char* points : {"depth", "scans"}) {
    const auto watch =
        open_people({}, profile(points, 5), "", sources({recording::kVelodyne, recording::kDepth}), monitor);
    ASSERT_TRUE(watch && watch->setup);
    EXPECT_EQ(watch->setup->by_depth, std::string(points) == "depth");
  }
}

}  // namespace
}  // namespace cairn::app
