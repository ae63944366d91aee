// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/merge_command.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kAnySize = 100'000'000;  // bytes

Outcome merge(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "merge");
  return run(add_merge_command, std::move(arguments));
}

class MergeCommand : public testing::Test {
 protected:
  void SetUp() override {
    const auto pair = support::two_robots(support::corridor(), {0, 1.5, 4}, {0.5, 2, 4}, 9);
    ASSERT_TRUE(mapping::save_cairn(*pair.a, folder / "a.cairn"));
    ASSERT_TRUE(mapping::save_cairn(*pair.b, folder / "b.cairn"));
    const Vector6 v = pair.T_a_b.xyz_rpy();
    pose = "--pose=" + std::to_string(v[0]);
    for (int k = 1; k < 6; ++k) pose += "," + std::to_string(v[k]);
  }
  TemporaryFolder folder;
  std::string pose;
};

TEST_F(MergeCommand, KnowsWhatEitherMapKnew) {
  const Outcome outcome = merge({folder / "a.cairn", folder / "b.cairn", pose, "--out", folder / "c.cairn", "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto a = mapping::load_map(folder / "a.cairn"), c = mapping::load_map(folder / "c.cairn");
  ASSERT_TRUE(a && c);
  const auto difference = report::compare(**a, **c);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->only_a, 0U);
  EXPECT_GT(difference->only_b, 1000U);
  EXPECT_EQ(outcome.json()["occupied"], report::summarise(**c).occupied);
  EXPECT_EQ(outcome.json()["policy"], "relative_entropy");
}

/// A pose that is known to 1 cm and 0.1°.
std::string small_covariance() {
  std::string text = "--covariance=";
  for (int i = 0; i < 36; ++i) text += std::string(i > 0 ? "," : "") + (i % 7 != 0 ? "0" : i < 18 ? "1e-4" : "3e-6");
  return text;
}

TEST_F(MergeCommand, AFusedVoxelKnowsItsVariance) {
  const auto [a, b, out] = std::array{folder / "a.cairn", folder / "b.cairn", folder / "c.cairn"};
  const Outcome plain = merge({a, b, pose, "--out", out, "--json"});
  ASSERT_EQ(plain.exit_code, app::kDone) << plain.err;
  EXPECT_FALSE(plain.json().contains("positions"));
  const auto map = read_file(out, kAnySize);
  const Outcome asked =
      merge({a, b, pose, small_covariance(), "--positions", folder / "p.ply", "--out", out, "--json"});
  ASSERT_EQ(asked.exit_code, app::kDone) << asked.err;
  EXPECT_EQ(*map, *read_file(out, kAnySize)) << "asking changes nothing";
  const auto places = asked.json()["positions"];
  EXPECT_EQ(places["voxels"], asked.json()["occupied"]);
  EXPECT_GT(places["shared"].get<int>(), 100);
  EXPECT_LT(places["shared_mean_m"].get<double>(), 0.8 * places["shared_alone_m"].get<double>());
  const auto file = read_file(folder / "p.ply", kAnySize);
  ASSERT_TRUE(file);
  const std::string text(reinterpret_cast<const char*>(file->data()), file->size());
  const std::string end = "end_header\n";
  EXPECT_EQ(text.size() - text.find(end) - end.size(), 25 * places["voxels"].get<std::size_t>());
}

TEST_F(MergeCommand, ACovarianceThatIsNoneIsRefused) {
  std::string negative = small_covariance(), skew = negative;
  negative.replace(negative.find("1e-4"), 4, "-1e-4");
  skew.replace(skew.find("1e-4,0"), 6, "1e-4,1e-5");
  for (const std::string& text : {negative, skew, small_covariance() + "x", std::string("--covariance=1,2,3")}) {
    const Outcome outcome = merge({folder / "a.cairn", folder / "b.cairn", pose, text, "--out", folder / "d.cairn"});
    EXPECT_EQ(outcome.exit_code, app::kWrongArguments) << text;
  }
  for (const char* name : {"p.txt", "d.ply"})
    EXPECT_EQ(
        merge({folder / "a.cairn", folder / "b.cairn", pose, "--positions", folder / name, "--out", folder / "d.ply"})
            .exit_code,
        app::kWrongArguments);
}

TEST_F(MergeCommand, APoseThatWouldLoseTheSecondMapIsRefused) {
  const auto refused = [&](const std::string& text) {
    const Outcome outcome =
        merge({folder / "a.cairn", folder / "b.cairn", "--pose=" + text, "--out", folder / "lost.ot"});
    EXPECT_EQ(outcome.exit_code, app::kWrongArguments) << text;
    EXPECT_FALSE(std::filesystem::exists(folder / "lost.ot"));
    return outcome.err;
  };
  EXPECT_THAT(refused("1e9,0,0,0,0,0"), HasSubstr("within 100 km"));
  EXPECT_THAT(refused("0,5000,0,0,0,0"), HasSubstr("outside of what a map can hold"));
  EXPECT_THAT(refused("0,0,0,0,0,90"),
              testing::AllOf(HasSubstr("radians"), HasSubstr("yaw is 90"), HasSubstr("1.5708")));
  EXPECT_EQ(
      merge({folder / "a.cairn", folder / "b.cairn", "--pose=2000,0,0,0,0,0", "--out", folder / "far.ot"}).exit_code,
      app::kDone);
}

TEST_F(MergeCommand, EntropiesAreInTheBooksOrder) {
  const auto entropy = [&](const std::string& policy) {
    return merge({folder / "a.cairn", folder / "b.cairn", pose, "--policy", policy, "--out", folder / "c.ot", "--json"})
        .json()["mean_entropy_occupancy"]
        .get<double>();
  };
  EXPECT_LT(entropy("relative_entropy"), entropy("average"));
  EXPECT_LT(entropy("bayes"), entropy("relative_entropy"));
}

TEST_F(MergeCommand, AMapWithItselfIsItselfForEveryPolicy) {
  for (const std::string policy : {"relative_entropy", "relative_entropy_weighted", "bayes", "average", "stitch"}) {
    const Outcome outcome = merge({folder / "a.cairn", folder / "a.cairn", "--pose=0,0,0,0,0,0", "--policy", policy,
                                   "--out", folder / "c.cairn"});
    ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
    EXPECT_EQ(mapping::encode_cairn(**mapping::load_map(folder / "a.cairn")),
              mapping::encode_cairn(**mapping::load_map(folder / "c.cairn")))
        << policy;
  }
}

TEST_F(MergeCommand, AnInputIsNotReplaced) {
  std::filesystem::create_symlink(folder / "b.cairn", folder / "link.cairn");
  for (const char* out : {"a.cairn", "b.cairn", "link.cairn"}) {
    const Outcome o = merge({folder / "a.cairn", folder / "b.cairn", pose, "--out", folder / out});
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << out;
    EXPECT_NE(o.err.find("would replace its own input"), std::string::npos);
  }
}

TEST_F(MergeCommand, FaultsExitAsPromised) {
  const std::string a = folder / "a.cairn", b = folder / "b.cairn", out = folder / "c.cairn";
  EXPECT_EQ(merge({a, folder / "none.ot", pose, "--out", out}).exit_code, app::kFailed);
  EXPECT_EQ(merge({a, b, pose, "--out", folder / "nowhere/c.ot"}).exit_code, app::kFailed);
  EXPECT_EQ(merge({a, b, "--out", out}).exit_code, app::kWrongArguments);
  EXPECT_EQ(merge({a, b, pose, "--out", folder / "c.stl"}).exit_code, app::kWrongArguments);
  EXPECT_THAT(merge({a, b, pose, "--out", folder / "c.stl"}).err, HasSubstr(".pcd"));
  EXPECT_EQ(merge({a, b, pose, "--policy", "sum", "--out", out}).exit_code, app::kWrongArguments);
  EXPECT_EQ(merge({a, b, "--pose=nan,0,0,0,0,0", "--out", out}).exit_code, app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli
