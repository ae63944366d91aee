// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/trajectory_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using ::testing::HasSubstr;

std::vector<StampedPose> random_trajectory(std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::int64_t ns = -3'000'000'007;
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < n; ++i) {
    ns += 1 + static_cast<std::int64_t>(random() % 1'000'000'000);
    Vector6 xi;
    for (double& v : xi) v = 3 * any(random);
    xi.head<3>() *= 1000;
    poses.push_back({Time(Duration(ns)), SE3::exp(xi)});
  }
  return poses;
}

TEST(Trajectory, WrittenAndReadAgainIsTheSame) {
  const test::TemporaryFolder folder;
  const auto poses = random_trajectory(1000);
  ASSERT_TRUE(write_tum(folder / "t.tum", poses));
  const auto again = read_tum(folder / "t.tum");
  ASSERT_TRUE(again) << to_string(again.error());
  ASSERT_EQ(again->size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ASSERT_EQ((*again)[i].stamp, poses[i].stamp);
    const Vector6 error = (poses[i].pose.inverse() * (*again)[i].pose).log();
    ASSERT_LT(error.head<3>().norm(), 1e-7) << "twelve digits of kilometres";
    ASSERT_LT(error.tail<3>().norm(), 1e-10);
  }
}

TEST(Trajectory, LinesLookAsEvoExpectsThem) {
  const SE3 half_turn(Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5), Eigen::Vector3d(1, -2.5, -0.0));
  const std::vector<StampedPose> poses{{Time(Duration(1'500'000'000'000'001)), SE3()},
                                       {Time(Duration(1'500'001'000'000'000)), half_turn}};
  EXPECT_EQ(to_tum(poses), "1500000.000000001 0 0 0 0 0 0 1\n1500001.000000000 1 -2.5 0 -0.5 0.5 -0.5 0.5\n");
}

TEST(Trajectory, CommentsEmptyLinesAndForeignNumbersAreRead) {
  std::vector<StampedPose> poses;
  ASSERT_TRUE(parse_tum("# t x y z\n\n 1.5e9 1 2 3 0 0 0 1\r\n1500000000.25\t+1 2 3 0 0 0 -1", "f", poses));
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].stamp.time_since_epoch().count(), 1'500'000'000'000'000'000);
  EXPECT_EQ(poses[1].stamp.time_since_epoch().count(), 1'500'000'000'250'000'000);
  EXPECT_EQ(poses[1].pose.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(Trajectory, AFaultNamesItsLineAndWhatWasBeforeIsKept) {
  const std::string good = "1.0 0 0 0 0 0 0 1\n";
  for (const char* bad :
       {"2 0 0 0 0 0 0", "2 0 0 0 0 0 0 1 9", "2 0 0 0 0 0 0 0", "2 nan 0 0 0 0 0 1", "2 inf 0 0 0 0 0 1",
        "1.0 0 0 0 0 0 0 1", "0.5 0 0 0 0 0 0 1", "x 0 0 0 0 0 0 1", "9.3e9 0 0 0 0 0 0 1", "2 1e10 0 0 0 0 0 1",
        "2 0 0 0 1 1 1 1", "2 0 0 0 0 0 0 1x", "2 0 0 0 nan 0 0 1"}) {
    std::vector<StampedPose> poses;
    const auto parsed = parse_tum(good + "# c\n" + bad + "\n3 0 0 0 0 0 0 1\n", "f", poses);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_THAT(parsed.error().detail, HasSubstr("line 3")) << bad;
    EXPECT_EQ(parsed.error().offset, good.size() + 4) << bad;
    EXPECT_EQ(poses.size(), 1U) << bad;
  }
}

TEST(Trajectory, CutAtEveryByteKeepsTheWholeLines) {
  const std::string text = to_tum(random_trajectory(5));
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const std::string_view cut = std::string_view(text).substr(0, n);
    std::vector<StampedPose> poses;
    static_cast<void>(parse_tum(cut, "f", poses));
    EXPECT_GE(poses.size(), static_cast<std::size_t>(std::count(cut.begin(), cut.end(), '\n')));
  }
}

TEST(Trajectory, NoFileIsSaid) {
  const auto none = read_tum("/nonexistent/t.tum");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::recording
