// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_file.hpp"

#include <gmock/gmock.h>

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

TEST(PeopleFile, ReadsRunsAndSimulations) {
  const auto run = parse_people(
      "t,id,x,y,vx,vy,sigma_m,sightings\n1.5,3,1.25,-2,0,0,0.1,7\n1.5,4,0,0,0,0,0.1,2\r\n\n1.600000001,3,1.5,-2,0,0,0."
      "1,8\n",
      "people.csv");
  ASSERT_TRUE(run) << to_string(run.error());
  ASSERT_EQ(run->size(), 3U);
  EXPECT_EQ((*run)[0].id, 3);
  EXPECT_EQ((*run)[0].position, Eigen::Vector2d(1.25, -2));
  EXPECT_EQ((*run)[2].stamp.time_since_epoch().count(), 1'600'000'001);
  const auto with_height =
      parse_people("t,id,x,y,vx,vy,sigma_m,sightings,z\n1.5,3,1.25,-2,0,0,0.1,7,0.5\n", "people.csv");
  ASSERT_TRUE(with_height) << to_string(with_height.error());
  EXPECT_EQ((*with_height)[0].ground, 0.5);
  EXPECT_EQ((*run)[0].ground, 0);
  const auto nobody = parse_people("t,id,x,y,vx,vy\n", "people.csv");
  ASSERT_TRUE(nobody);
  EXPECT_TRUE(nobody->empty());
}

TEST(PeopleFile, FaultsNameTheLine) {
  const auto fault = [](const std::string& rows) {
    const auto parsed = parse_people("t,id,x,y,vx,vy\n" + rows, "people.csv");
    return parsed ? std::string("none") : to_string(parsed.error());
  };
  EXPECT_THAT(fault("1,0,2\n"), HasSubstr("line 2"));
  EXPECT_THAT(fault("1,0,2,3\nnan,0,2,3\n"), HasSubstr("line 3"));
  EXPECT_THAT(fault("1,0.5,2,3\n"), HasSubstr("not an id"));
  EXPECT_THAT(fault("1,-1,2,3\n"), HasSubstr("not an id"));
  EXPECT_THAT(fault("1,0,inf,3\n"), HasSubstr("not a usable position"));
  EXPECT_THAT(fault("1,0,2,1e300\n"), HasSubstr("not a usable position"));
  EXPECT_THAT(to_string(parse_people("t,id,x,y,vx,vy,sigma_m,sightings,z\n1,0,2,3\n", "people.csv").error()),
              HasSubstr("height of the ground"));
  EXPECT_THAT(fault("2,0,2,3\n1,0,2,3\n"), HasSubstr("the times decrease"));
  EXPECT_THAT(fault("2,0,2,3\n2,0,2,3\n"), HasSubstr("twice"));
  EXPECT_THAT(to_string(parse_people("", "people.csv").error()), HasSubstr("not a table of people"));
  EXPECT_THAT(to_string(parse_people("1,0,2,3\n", "people.csv").error()), HasSubstr("t,id,x,y"));
}

TEST(PeopleFile, ACrowdAtOneTimeIsBounded) {
  std::string text = "t,id,x,y\n";
  for (int i = 0; i < 5000; ++i) text += "1," + std::to_string(i) + ",0,0\n";
  EXPECT_THAT(to_string(parse_people(text, "people.csv").error()), HasSubstr("too many people at one time"));
}

}  // namespace
}  // namespace cairn::cli
