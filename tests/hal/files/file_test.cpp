// SPDX-License-Identifier: Apache-2.0
#include "hal/files/file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  std::string text(const fs::path& path) {
    const auto bytes = read_file(path, 1000);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "error";
  }
  support::TemporaryFolder folder_;
};

TEST_F(FileTest, WritesReadsAndReplaces) {
  const fs::path file = folder_ / "map";
  ASSERT_TRUE(write_file_atomic(file, "one"));
  EXPECT_EQ(text(file), "one");
  ASSERT_TRUE(write_file_atomic(file, ""));
  EXPECT_EQ(text(file), "");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "no temporary file may stay";
}

TEST_F(FileTest, AFailedWriteKeepsTheOldContentAndLeavesNothingBehind) {
  const fs::path target = folder_ / "map";
  fs::create_directory(target);  // rename onto a folder fails after the temporary file was written
  const auto result = write_file_atomic(target, "new");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, target.string());
  EXPECT_TRUE(fs::is_directory(target));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(FileTest, AFullDiskIsAnErrorWithTheSystemsReason) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "/dev/full is missing";
  fs::create_symlink("/dev/full", folder_ / "map.tmp");  // the temporary name leads to a disk without room
  const auto result = write_file_atomic(folder_ / "map", "x");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kIo);
  EXPECT_NE(result.error().detail.find("No space left"), std::string::npos) << result.error().detail;
  EXPECT_FALSE(fs::exists(folder_ / "map"));
}

TEST_F(FileTest, RefusesWhatIsTooLargeMissingOrNoFile) {
  ASSERT_TRUE(write_file_atomic(folder_ / "big", "12345"));
  EXPECT_EQ(read_file(folder_ / "big", 4).error().code, Errc::kLimit);
  EXPECT_EQ(read_file(folder_ / "none", 4).error().code, Errc::kNotFound);
  EXPECT_FALSE(read_file(folder_.path(), 4));
}

}  // namespace
}  // namespace cairn
