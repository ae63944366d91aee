// SPDX-License-Identifier: Apache-2.0
#include "hal/files/unfinished_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

namespace fs = std::filesystem;

struct UnfinishedFolderTest : ::testing::Test {
  static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string text_in(const fs::path& file) {
    const auto bytes = read_file(file, 1000);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "error";
  }
  support::TemporaryFolder folder;
};

TEST_F(UnfinishedFolderTest, AppearsAtItsEndAndNotBefore) {
  const fs::path target = folder / "deep" / "target";
  {
    auto unfinished = UnfinishedFolder::beside(target / "");
    ASSERT_TRUE(unfinished) << to_string(unfinished.error());
    EXPECT_EQ(unfinished->path().filename(), "target.unfinished");
    put(unfinished->path() / "a", "new");
    EXPECT_FALSE(fs::exists(target));
    ASSERT_TRUE(unfinished->become(target));
  }
  EXPECT_EQ(text_in(target / "a"), "new");
  EXPECT_FALSE(fs::exists(folder / "deep" / "target.unfinished"));
}

TEST_F(UnfinishedFolderTest, WhatComesToNothingLeavesNothing) {
  (void)UnfinishedFolder::beside(folder / "target");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(UnfinishedFolderTest, AnEmptyFolderIsTakenAndAFullOneIsNot) {
  fs::create_directory(folder / "target");
  auto first = UnfinishedFolder::beside(folder / "target").value();
  put(first.path() / "a", "first");
  ASSERT_TRUE(first.become(folder / "target"));
  auto second = UnfinishedFolder::beside(folder / "target").value();
  EXPECT_FALSE(second.become(folder / "target"));
  EXPECT_EQ(text_in(folder / "target" / "a"), "first");
}

TEST_F(UnfinishedFolderTest, ASwapGivesTheOldOne) {
  fs::create_directory(folder / "target");
  put(folder / "target" / "a", "old");
  {
    auto unfinished = UnfinishedFolder::beside(folder / "target").value();
    put(unfinished.path() / "a", "new");
    ASSERT_TRUE(unfinished.swap_with(folder / "target"));
    EXPECT_EQ(text_in(folder / "target" / "a"), "new");
    EXPECT_EQ(text_in(unfinished.path() / "a"), "old");
  }
  EXPECT_FALSE(fs::exists(folder / "target.unfinished"));
}

TEST_F(UnfinishedFolderTest, WhatAKilledProgramLeftKeepsItsName) {
  fs::create_directory(folder / "target.unfinished");
  put(folder / "target.unfinished" / "old", "of a killed program");
  EXPECT_EQ(UnfinishedFolder::beside(folder / "target").value().path().filename(), "target.unfinished-2");
  EXPECT_TRUE(fs::exists(folder / "target.unfinished" / "old"));
}

TEST_F(UnfinishedFolderTest, InsideAFolderALeftoverIsRemovedUnlessItsProgramRuns) {
  fs::create_directories(folder / "out" / "unfinished");
  put(folder / "out" / "unfinished" / "old", "of a killed program");
  const auto one = UnfinishedFolder::inside(folder / "out").value();
  EXPECT_TRUE(fs::is_empty(one.path()));
  const auto other = UnfinishedFolder::inside(folder / "out");
  ASSERT_FALSE(other);
  EXPECT_NE(to_string(other.error()).find("another program is writing there"), std::string::npos);
}

TEST_F(UnfinishedFolderTest, WhatIsLeftStays) {
  UnfinishedFolder::beside(folder / "target").value().leave();
  EXPECT_TRUE(fs::exists(folder / "target.unfinished"));
}

TEST_F(UnfinishedFolderTest, FilesMoveIntoAFolderOverTheOldOnes) {
  {
    auto unfinished = UnfinishedFolder::inside(folder / "out").value();
    put(folder / "out" / "map", "old");
    put(folder / "out" / "mine", "kept");
    put(unfinished.path() / "map", "new");
    put(unfinished.path() / "report", "new");
    ASSERT_TRUE(unfinished.move_files_into(folder / "out", "report"));
  }
  EXPECT_EQ(text_in(folder / "out" / "map"), "new");
  EXPECT_EQ(text_in(folder / "out" / "report"), "new");
  EXPECT_EQ(text_in(folder / "out" / "mine"), "kept");
  EXPECT_FALSE(fs::exists(folder / "out" / "unfinished"));
}

TEST_F(UnfinishedFolderTest, WhatCannotBeReplacedIsRefusedBeforeTheWork) {
  put(folder / "file", "x");
  for (const fs::path& target :
       {folder / "file", fs::current_path(), fs::path("."), fs::path("/"), fs::path("/proc")}) {
    const auto refused = UnfinishedFolder::beside(target);
    ASSERT_FALSE(refused) << target;
    EXPECT_EQ(refused.error().code, Errc::kInvalidConfig) << target;
  }
  EXPECT_FALSE(UnfinishedFolder::inside(folder / "file"));
}

TEST_F(UnfinishedFolderTest, AnOutputThatWouldDestroyItsInputIsRefused) {
  fs::create_directories(folder / "rec" / "camera");
  fs::create_directory(folder / "other");
  fs::create_directory_symlink(folder / "rec", folder / "link");
  const fs::path rec = folder / "rec";
  for (const fs::path& output : {rec, rec / "", rec / ".", folder / "link", folder / "other" / ".." / "rec",
                                 folder / "link" / "new", rec / "camera", folder.path()})
    EXPECT_FALSE(keep_input(rec, output)) << output;
  for (const fs::path& output : {folder / "other", folder / "rec2", folder / "new" / "rec"})
    EXPECT_TRUE(keep_input(rec, output)) << output;
}

TEST_F(UnfinishedFolderTest, AnErrorOfWritingSaysThatNothingIsKept) {
  const auto made = UnfinishedFolder::beside(folder / "out").value();
  const Error inside{Errc::kIo, "cannot write the file", (made.path() / "a" / "b").string(), 9, "full"};
  EXPECT_EQ(made.nothing_kept(inside).detail,
            "full; nothing was kept: free space on the disk, or name another --out, and run it again");
  const Error input{Errc::kIo, "cannot be read", (folder / "in").string(), {}, "broken"};
  EXPECT_EQ(made.nothing_kept(input).detail, "broken");
  EXPECT_EQ(made.nothing_kept({Errc::kTruncated, "interrupted", made.path().string(), {}, "x"}).detail, "x");
}

TEST_F(UnfinishedFolderTest, ANewFolderIsMissingOrEmpty) {
  EXPECT_TRUE(require_new_folder(folder / "out", "x"));
  fs::create_directory(folder / "out");
  EXPECT_TRUE(require_new_folder(folder / "out", "x"));
  put(folder / "out" / "file", "mine");
  for (const fs::path& used : {folder / "out", folder / "out" / "file"}) {
    const auto refused = require_new_folder(used, "choose another");
    ASSERT_FALSE(refused) << used;
    EXPECT_EQ(refused.error().detail, "choose another");
  }
}

}  // namespace
}  // namespace cairn
