// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_command.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <fstream>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using testing::HasSubstr;

Outcome map(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "map");
  return run(add_map_command, std::move(arguments));
}

/// Two occupied voxels, one free one, and a pruned free cube of 8.
std::unique_ptr<mapping::SemanticOcTree> small_map() {
  auto tree = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (int i = 0; i < 10; ++i) {
    tree->updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
    tree->updateNode(octomap::point3d(1.05F, 0.05F, 0.05F), true);
    tree->updateNode(octomap::point3d(0.55F, 0.05F, 0.05F), false);
    for (int k = 0; k < 8; ++k) {
      const auto at = [&](int bit) { return (k >> bit & 1) != 0 ? 0.5F : 0.0F; };
      tree->updateNode(octomap::point3d(2.05F + 0.2F * at(0), 0.05F + 0.2F * at(1), 0.05F + 0.2F * at(2)), false);
    }
  }
  return tree;
}

TEST(MapCommand, InfoCountsVoxelsNotLeaves) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  const Outcome outcome = map({"info", folder / "a.cairn", "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json["occupied"], 2);
  EXPECT_EQ(json["free"], 9);
  EXPECT_EQ(json["labelled"], 0);
  EXPECT_EQ(json["checksum"], "ok");
  EXPECT_EQ(json["resolution_m"], 0.1);
  EXPECT_EQ(json["leaves"], 4);
  EXPECT_NEAR(json["known_volume_m3"], 0.011, 1e-9);
  EXPECT_NEAR(json["min_m"][0], 0.0, 1e-9);
  EXPECT_NEAR(json["max_m"][0], 2.2, 1e-6);
  EXPECT_EQ(json["file_bytes"], std::filesystem::file_size(folder / "a.cairn"));
  EXPECT_THAT(map({"info", folder / "a.cairn"}).out, HasSubstr("occupied      2 voxels"));
}

TEST(MapCommand, InfoKnowsAMapByItsContentNotByItsName) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "with_checksum.ot"));
  ASSERT_TRUE(mapping::save_ot(*small_map(), folder / "without.cairn"));
  EXPECT_EQ(map({"info", folder / "with_checksum.ot", "--json"}).json()["checksum"], "ok");
  EXPECT_EQ(map({"info", folder / "without.cairn", "--json"}).json()["checksum"], "none");
}

TEST(MapCommand, CompareNamesAllFields) {
  const TemporaryFolder folder;
  auto other = small_map();
  other->updateNode(octomap::point3d(5.05F, 0.05F, 0.05F), true);
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  ASSERT_TRUE(mapping::save_ot(*other, folder / "b.ot"));
  const Outcome outcome = map({"compare", folder / "a.cairn", folder / "b.ot", "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json["same"], 11);
  EXPECT_EQ(json["disagreeing"], 0);
  EXPECT_EQ(json["only_a"], 0);
  EXPECT_EQ(json["only_b"], 1);
  EXPECT_NEAR(json["iou_occupied"], 2.0 / 3, 1e-12);
  EXPECT_GT(json["mean_entropy_occupancy"], 0.0);
  for (const char* name : {"label_agreement", "miou", "mean_entropy_label"}) EXPECT_TRUE(json.at(name).is_null());
}

/// The small map with a car and a pole.
std::unique_ptr<mapping::SemanticOcTree> labelled_map() {
  auto tree = small_map();
  tree->search(0.05, 0.05, 0.05)->set_label_id(mapping::VoxelLabel::of(13, 0).code);
  tree->search(1.05, 0.05, 0.05)->set_label_id(mapping::VoxelLabel::of(5, 0).code);
  return tree;
}

TEST(MapCommand, InfoAndCompareCountClasses) {
  const TemporaryFolder folder;
  auto other = labelled_map();
  other->search(1.05, 0.05, 0.05)->set_label_id(mapping::VoxelLabel::of(6, 0).code);
  ASSERT_TRUE(mapping::save_ot(*labelled_map(), folder / "a.ot"));
  ASSERT_TRUE(mapping::save_cairn(*other, folder / "b.cairn"));
  const auto info = map({"info", folder / "a.ot", "--json"}).json();
  EXPECT_EQ(info["labelled"], 2);
  EXPECT_EQ(info["classes"], (nlohmann::json{{"car", 1}, {"pole", 1}}));
  EXPECT_THAT(map({"info", folder / "a.ot"}).out, HasSubstr("    pole          1 voxels"));
  const auto json = map({"compare", folder / "a.ot", folder / "b.cairn", "--json"}).json();
  EXPECT_EQ(json["labelled_both"], 2);
  EXPECT_EQ(json["label_agreement"], 0.5);
  EXPECT_NEAR(json["miou"], 1.0 / 3, 1e-12);  // car 1, pole 0, traffic light 0
  EXPECT_GT(json["mean_entropy_label"], 0.0);
  EXPECT_THAT(map({"compare", folder / "a.ot", folder / "b.cairn"}).out, HasSubstr("2 voxels labelled in both"));
}

TEST(MapCommand, RendersClassesWhereThereAreAny) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*labelled_map(), folder / "a.cairn"));
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "b.cairn"));
  EXPECT_EQ(map({"render", folder / "a.cairn", "--classes", "--out", folder / "a.png"}).exit_code, app::kDone);
  const Outcome none = map({"render", folder / "b.cairn", "--classes", "--out", folder / "b.png"});
  EXPECT_EQ(none.exit_code, app::kFailed);
  EXPECT_THAT(none.err, HasSubstr("no voxel in this view has a label"));
}

TEST(MapCommand, CompareRefusesAnotherResolution) {
  const TemporaryFolder folder;
  mapping::SemanticOcTree coarse(0.2);
  coarse.updateNode(octomap::point3d(0.1F, 0.1F, 0.1F), true);
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  ASSERT_TRUE(mapping::save_cairn(coarse, folder / "b.cairn"));
  const Outcome outcome = map({"compare", folder / "a.cairn", folder / "b.cairn", "--json"});
  EXPECT_EQ(outcome.exit_code, app::kFailed);
  EXPECT_TRUE(outcome.out.empty());
  EXPECT_THAT(outcome.err, HasSubstr("0.1 m and 0.2 m"));
}

TEST(MapCommand, RenderWritesAPngOfTheSizeItTells) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  ASSERT_TRUE(recording::write_tum(
      folder / "t.tum",
      std::vector<recording::StampedPose>{{Time{from_seconds(0)}, SE3()}, {Time{from_seconds(1)}, SE3()}}));
  for (const std::string view : {"top", "side", "front"}) {
    const Outcome outcome =
        map({"render", folder / "a.cairn", "--out", folder / "a.png", "--view", view, "--height-min", "-1", "--scale",
             "100", "--trajectory", folder / "t.tum", "--ground-truth", folder / "t.tum", "--json"});
    ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, (folder / "a.png").c_str()), 0);
    EXPECT_EQ(png.width, outcome.json()["width"]);
    EXPECT_EQ(png.height, outcome.json()["height"]);
    png_image_free(&png);
  }
}

TEST(MapCommand, AnInputIsNotReplaced) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  for (const char* what : {"export", "render"})
    EXPECT_EQ(map({what, folder / "a.cairn", "--out", folder / "a.cairn"}).exit_code, app::kWrongArguments) << what;
  EXPECT_TRUE(mapping::load_map(folder / "a.cairn"));
}

TEST(MapCommand, ExportReadsBackTheSame) {
  const TemporaryFolder folder;
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  for (const std::string name : {"b.ot", "b.cairn"}) {
    ASSERT_EQ(map({"export", folder / "a.cairn", "--out", folder / name}).exit_code, app::kDone);
    const auto json = map({"compare", folder / "a.cairn", folder / name, "--json"}).json();
    EXPECT_EQ(json["same"], 11) << name;
    EXPECT_EQ(json["differing_log_odds"], 0) << name;
  }
  for (const std::string name : {"b.bt", "b.ply", "b.pcd"}) {
    const Outcome outcome = map({"export", folder / "a.cairn", "--out", folder / name, "--json"});
    ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
    EXPECT_EQ(outcome.json()["bytes"], std::filesystem::file_size(folder / name));
  }
  EXPECT_EQ(map({"compare", folder / "a.cairn", folder / "b.bt", "--json"}).json()["same"], 11);
}

TEST(MapCommand, FaultsNameTheFileAndExitAsPromised) {
  const TemporaryFolder folder;
  std::ofstream(folder / "broken.cairn") << "this is no map";
  ASSERT_TRUE(mapping::save_cairn(*small_map(), folder / "a.cairn"));
  const auto expect = [&](std::vector<std::string> arguments, int code, const std::string& message) {
    const Outcome outcome = map(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  expect({"info", folder / "none.cairn"}, app::kFailed, "none.cairn");
  expect({"info", folder / "broken.cairn", "--json"}, app::kFailed, "broken.cairn");
  expect({"info"}, app::kWrongArguments, "file");
  expect({}, app::kWrongArguments, "subcommand");
  expect({"export", folder / "a.cairn", "--out", folder / "a.stl"}, app::kWrongArguments, ".pcd");
  expect({"render", folder / "a.cairn", "--out", folder / "a.png", "--view", "inside"}, app::kWrongArguments, "inside");
  expect({"render", folder / "a.cairn", "--out", folder / "a.jpg"}, app::kWrongArguments, "must end in .png");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.jpg"));
  expect({"render", folder / "a.cairn", "--out", folder / "a.png", "--height-min", "50"}, app::kFailed, "empty");
  expect({"render", folder / "a.cairn", "--out", folder / "a.png", "--scale", "1e9"}, app::kFailed, "too large");
  expect({"render", folder / "a.cairn", "--out", folder / "nowhere/a.png"}, app::kFailed, "nowhere");
}

}  // namespace
}  // namespace cairn::cli
