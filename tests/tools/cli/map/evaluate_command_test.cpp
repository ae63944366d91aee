// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/evaluate_command.hpp"

#include <gmock/gmock.h>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using recording::StampedPose;
using testing::HasSubstr;

Outcome evaluate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "evaluate");
  return run(add_evaluate_command, std::move(arguments));
}

/// Straight along x, 10 m, longer by `scale`, and turned and shifted as a whole.
std::vector<StampedPose> line(double scale, const SE3& T = {}) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i)
    poses.push_back(
        {Time{from_seconds(0.1 * i)}, T * SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1 * i * scale, 0, 0))});
  return poses;
}

const SE3 kElsewhere = SE3::from_xyz_rpy((Vector6() << 3, -2, 1, 0, 0, 1.2).finished());

TEST(EvaluateTrajectory, NamesItsFieldsAndGetsAScaledLineRight) {
  const TemporaryFolder folder;
  ASSERT_TRUE(recording::write_tum(folder / "trajectory.tum", line(1.02, kElsewhere)));
  ASSERT_TRUE(recording::write_tum(folder / "ground_truth.tum", line(1)));
  // Folders stand for the files that a run and a recording leave in them.
  const Outcome outcome = evaluate({"trajectory", folder.path(), "--ground-truth", folder.path(), "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  EXPECT_NEAR(json["length_m"], 10, 1e-6);
  EXPECT_NEAR(json["rpe_trans_percent"], 2, 1e-4);
  EXPECT_NEAR(json["rpe_rot_deg_per_m"], 0, 1e-4);
  EXPECT_NEAR(json["final_error_percent"], 2, 1e-4);
  EXPECT_NEAR(json["ate_rmse_m"], 0.2 / std::sqrt(12), 2e-3);
  EXPECT_NEAR(json["ate_first_rmse_m"], 0.2 / std::sqrt(3), 2e-3);
  EXPECT_EQ(json["align"], "se3");
  const auto first =
      evaluate({"trajectory", folder.path(), "--ground-truth", folder.path(), "--align", "first", "--json"}).json();
  EXPECT_EQ(first["ate_rmse_m"], json["ate_first_rmse_m"]);
  EXPECT_THAT(evaluate({"trajectory", folder.path(), "--ground-truth", folder.path()}).out, HasSubstr("2.000 %"));
}

TEST(EvaluateTrajectory, FaultsNameTheFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(recording::write_tum(folder / "a.tum", line(1)));
  const Outcome missing = evaluate({"trajectory", folder / "a.tum", "--ground-truth", folder / "b.tum"});
  EXPECT_EQ(missing.exit_code, app::kFailed);
  EXPECT_THAT(missing.err, HasSubstr("b.tum"));
  EXPECT_EQ(evaluate({"trajectory", folder / "a.tum"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(evaluate({"trajectory", folder / "a.tum", "--ground-truth", folder / "a.tum", "--align", "best"}).exit_code,
            app::kWrongArguments);
}

/// A wall of 20 × 10 voxels at x = 2 m in the world, with known free space before it.
std::unique_ptr<mapping::SemanticOcTree> wall(const SE3& T_map_world) {
  auto tree = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 10; ++z) {
      const Eigen::Vector3f p = (T_map_world * Eigen::Vector3d(2.05, 0.1 * y + 0.05, 0.1 * z + 0.05)).cast<float>();
      tree->updateNode(octomap::point3d(p.x(), p.y(), p.z()), true);
    }
  return tree;
}

TEST(EvaluateMap, TakesThePoseFromFlagOrTrajectories) {
  const TemporaryFolder folder;
  // The map's frame is 1 m ahead of the world's and turned by 90°.
  const SE3 T_world_map = SE3::from_xyz_rpy((Vector6() << 1, -0.5, 0, 0, 0, 1.5707963267948966).finished());
  ASSERT_TRUE(mapping::save_cairn(*wall(T_world_map.inverse()), folder / "map.cairn"));
  ASSERT_TRUE(mapping::save_ot(*wall({}), folder / "world.ot"));
  ASSERT_TRUE(recording::write_tum(folder / "trajectory.tum", line(1)));
  ASSERT_TRUE(recording::write_tum(folder / "ground_truth.tum", line(1, T_world_map)));
  const std::vector<std::vector<std::string>> ways{
      {"--pose", "1,-0.5,0,0,0,1.5707963267948966"},
      {"--trajectory", folder.path(), "--ground-truth-trajectory", folder.path()}};
  for (const auto& way : ways) {
    std::vector<std::string> arguments{"map", folder.path(), "--ground-truth", folder.path(), "--json"};
    arguments.insert(arguments.end(), way.begin(), way.end());
    const Outcome outcome = evaluate(arguments);
    ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
    EXPECT_EQ(outcome.json()["precision"], 1.0);
    EXPECT_TRUE(outcome.json()["hint"].is_null());
    EXPECT_EQ(outcome.json()["recall"], 1.0);
    EXPECT_EQ(outcome.json()["occupied"], 200);
    EXPECT_LT(outcome.json()["accuracy_mean_m"], 1e-4);
  }
  const auto unaligned = evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--json"}).json();
  EXPECT_LT(unaligned["precision"], 0.2);
  EXPECT_THAT(unaligned["hint"].get<std::string>(), HasSubstr("--trajectory"));
  EXPECT_THAT(evaluate({"map", folder.path(), "--ground-truth", folder.path()}).out,
              HasSubstr("seem not to be aligned"));
}

/// Labels the lower half of a wall as wall, the upper one as `upper`.
void label_wall(mapping::SemanticOcTree& tree, unsigned upper) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    leaf->set_label_id(mapping::VoxelLabel::of(leaf.getZ() < 0.5 ? 3 : upper, 0).code);
}

TEST(EvaluateMap, SaysHowManyLabelsAreRight) {
  const TemporaryFolder folder;
  const auto truth = wall({}), map = wall({});
  label_wall(*truth, 3);
  label_wall(*map, 8);
  ASSERT_TRUE(mapping::save_cairn(*map, folder / "map.cairn"));
  ASSERT_TRUE(mapping::save_ot(*truth, folder / "world.ot"));
  const auto json = evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--json"}).json();
  EXPECT_EQ(json["label_accuracy"], 0.5);
  EXPECT_EQ(json["miou"], 0.5);
  EXPECT_EQ(json["iou_by_class"], (nlohmann::json{{"wall", 0.5}}));
  EXPECT_EQ(json["true_voxels_by_class"], (nlohmann::json{{"wall", 200}}));
  EXPECT_EQ(json["labelled_share"], 1.0);
  EXPECT_THAT(evaluate({"map", folder.path(), "--ground-truth", folder.path()}).out,
              HasSubstr("labels     0.5000 right of 200 voxels"));
}

TEST(EvaluateMap, WithoutLabelsTheFieldsAreNull) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*wall({}), folder / "map.cairn"));
  ASSERT_TRUE(mapping::save_ot(*wall({}), folder / "world.ot"));
  const auto json = evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--json"}).json();
  EXPECT_TRUE(json.at("label_accuracy").is_null());
  EXPECT_TRUE(json.at("miou").is_null());
  EXPECT_EQ(json["precision"], 1.0);
}

TEST(EvaluateMap, AnAlignmentNeedsTrajectories) {
  const TemporaryFolder folder;
  const Outcome o = evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--align", "se3"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("--align requires --trajectory"));
}

TEST(EvaluateMap, RefusesHalfAPose) {
  const TemporaryFolder folder;
  EXPECT_EQ(evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--pose", "1,2,3"}).exit_code,
            app::kWrongArguments);
  EXPECT_EQ(evaluate({"map", folder.path(), "--ground-truth", folder.path(), "--trajectory", "a"}).exit_code,
            app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli
