// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/team_recordings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/tools/team/sample_team.hpp"

namespace cairn::team_run {
namespace {

using ::testing::HasSubstr;

TEST(SurveyRecordings, TakesRecordingsAndFoldersOfThem) {
  const support::TemporaryFolder folder;
  for (const int robot : {2, 1}) SampleTeam{}.write_recording(folder / ("robot_" + std::to_string(robot)), robot);
  for (const auto& folders : {std::vector{folder.path()}, std::vector{folder / "robot_1", folder / "robot_2"}}) {
    const auto found = survey_recordings(folders);
    ASSERT_TRUE(found) << to_string(found.error());
    ASSERT_EQ(found->size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ((*found)[i].name, "robot_" + std::to_string(i + 1));
      EXPECT_EQ((*found)[i].length, (SampleTeam::kPackets - 1) * std::chrono::milliseconds(100));
      EXPECT_EQ((*found)[i].raw_bytes, SampleTeam::kPackets * SampleTeam::kBytes);
    }
  }
}

TEST(SurveyRecordings, RefusesOneRobotTwoOfOneNameAndWhatIsNone) {
  const support::TemporaryFolder folder;
  SampleTeam{}.write_recording(folder / "a", 1);
  EXPECT_THAT(to_string(survey_recordings({folder / "a"}).error()), HasSubstr("two robots at least"));
  EXPECT_THAT(to_string(survey_recordings({folder / "a", folder / "a"}).error()),
              HasSubstr("another robot has this name"));
  EXPECT_FALSE(survey_recordings({folder / "nowhere", folder / "a"}));
}

}  // namespace
}  // namespace cairn::team_run
