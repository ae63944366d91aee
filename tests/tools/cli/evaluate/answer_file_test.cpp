// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/answer_file.hpp"

#include <gmock/gmock.h>

#include "onboard/app/perception/answer_log.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

TEST(AnswerFile, ReadsWhatARunWrites) {
  const std::vector<people::Answered> told{
      {.scan = Time{from_seconds(2.5)},
       .eye = people::Eye::kThermal,
       .body = {1.25F, -2},
       .ground = 0.5F,
       .answer = {.verdict = people::Verdict::kPerson, .score = 0.75F, .distance = 4.5}},
      {.scan = Time{from_seconds(2.6)},
       .eye = people::Eye::kVisible,
       .body = {0, 3},
       .ground = 0,
       .answer = {.verdict = people::Verdict::kSilence, .score = 0, .distance = 3}}};
  app::AnswerLog log;
  log.add(told);
  const auto rows = parse_answers(log.to_csv(from_seconds(1)), "answers.csv");
  ASSERT_TRUE(rows) << to_string(rows.error());
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ((*rows)[0].stamp, Time{from_seconds(1.5)});
  EXPECT_TRUE((*rows)[0].thermal && (*rows)[0].boxed);
  EXPECT_EQ((*rows)[0].position, Eigen::Vector2d(1.25, -2));
  EXPECT_EQ((*rows)[0].ground, 0.5);
  EXPECT_EQ((*rows)[0].score, 0.75);
  EXPECT_EQ((*rows)[0].distance_m, 4.5);
  EXPECT_FALSE((*rows)[1].thermal || (*rows)[1].boxed);
}

TEST(AnswerFile, FaultsNameTheLine) {
  const auto fault = [](const std::string& rows) {
    const auto parsed = parse_answers("t,camera,x,y,z,verdict,score,distance_m\n" + rows, "answers.csv");
    return parsed ? std::string("none") : to_string(parsed.error());
  };
  EXPECT_THAT(fault("1,thermal,2,3,0,person,0.5,4\n1,thermal,2,3\n"), HasSubstr("line 3"));
  EXPECT_THAT(fault("x,thermal,2,3,0,person,0.5,4\n"), HasSubstr("not a time"));
  EXPECT_THAT(fault("1,lidar,2,3,0,person,0.5,4\n"), HasSubstr("not a camera"));
  EXPECT_THAT(fault("1,thermal,nan,3,0,person,0.5,4\n"), HasSubstr("not a usable position"));
  EXPECT_THAT(fault("1,thermal,2,3,0,maybe,0.5,4\n"), HasSubstr("not a verdict"));
  EXPECT_THAT(fault("1,thermal,2,3,0,person,1.5,4\n"), HasSubstr("not a score"));
  EXPECT_THAT(fault("1,thermal,2,3,0,person,0.5,-4\n"), HasSubstr("not a distance"));
  EXPECT_THAT(to_string(parse_answers("", "answers.csv").error()), HasSubstr("not a table of answers"));
}

}  // namespace
}  // namespace cairn::cli
