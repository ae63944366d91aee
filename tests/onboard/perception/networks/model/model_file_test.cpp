// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/model_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <array>
#include <cctype>

#include "tests/onboard/perception/networks/tiny_onnx.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::networks {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(FindModel, TheFirstFolderThatHasItIsTaken) {
  const support::TemporaryFolder folder;
  fs::create_directories(folder / "profile");
  fs::create_directories(folder / "installed/models");
  test::colours().save(folder / "installed/models/a.onnx");
  const std::array folders{folder / "profile", folder / "installed"};
  EXPECT_EQ(find_model("models/a.onnx", folders).value(), folder / "installed/models/a.onnx");
  fs::create_directories(folder / "profile/models");
  test::colours().save(folder / "profile/models/a.onnx");
  EXPECT_EQ(find_model("models/a.onnx", folders).value(), folder / "profile/models/a.onnx");
  EXPECT_EQ(find_model(folder / "installed/models/a.onnx", folders).value(), folder / "installed/models/a.onnx");
}

TEST(FindModel, AMissingModelNamesAllPlaces) {
  const std::array folders{fs::path("here"), fs::path("there")};
  const auto found = find_model("m.onnx", folders);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::kNotFound);
  EXPECT_THAT(to_string(found.error()), AllOf(HasSubstr("here/m.onnx"), HasSubstr("there/m.onnx")));
}

TEST(FindModel, TheProfilesFolderComesFirst) {
  EXPECT_EQ(model_folders("/etc/robot.yaml").front(), "/etc");
  EXPECT_EQ(model_folders("robot.yaml").front(), ".");
  EXPECT_EQ(model_folders({}).front(), ".");
}

TEST(ReadModel, TheSumIsCheckedWhereItIsGiven) {
  const support::TemporaryFolder folder;
  test::colours().save(folder / "a.onnx");
  const auto model = read_model(folder / "a.onnx", "", {});
  ASSERT_TRUE(model) << to_string(model.error());
  std::string sum = model->sha256;
  EXPECT_EQ(sum.size(), 64U);
  for (char& c : sum) c = static_cast<char>(std::toupper(c));
  EXPECT_TRUE(read_model(folder / "a.onnx", sum, {}));
  sum[5] = sum[5] == '0' ? '1' : '0';
  const auto other = read_model(folder / "a.onnx", sum, {});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(to_string(other.error()), AllOf(HasSubstr("a.onnx"), HasSubstr(sum), HasSubstr(model->sha256)));
}

TEST(ReadModel, AFileThatIsCutOffIsCalledThatWhateverItsSum) {
  const support::TemporaryFolder folder;
  const std::string whole = test::colours().text();
  std::ofstream(folder / "a.onnx", std::ios::binary) << whole.substr(0, whole.size() / 2);
  const auto model = read_model(folder / "a.onnx", std::string(64, '0'), {});
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Errc::kTruncated);
  EXPECT_EQ(model.error().offset, whole.size() / 2);
}

TEST(ReadModel, WhatIsNoFileIsRefusedAtOnce) {
  const support::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_model(folder / "pipe", "", {}).error().code, Errc::kUnsupported);
  EXPECT_EQ(read_model(folder.path(), "", {}).error().code, Errc::kUnsupported);
  std::ofstream(folder / "huge") << "x";
  fs::resize_file(folder / "huge", kMaxModelBytes + 1);
  EXPECT_EQ(read_model(folder / "huge", "", {}).error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::networks
