// SPDX-License-Identifier: Apache-2.0
#include "hal/files/append_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A disk with room for `bytes` per file, as long as it lives.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

std::string written_in(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(AppendFile, HoldsTheRecordsInOrder) {
  const support::TemporaryFolder folder;
  std::string expected;
  auto file = AppendFile::create(folder / "f");
  ASSERT_TRUE(file);
  for (int i = 0; i < 100'000; ++i) {
    expected += std::to_string(i) + "\n";
    ASSERT_TRUE(file->append_line(std::to_string(i) + "\n"));
  }
  ASSERT_TRUE(file->close());
  EXPECT_EQ(written_in(folder / "f"), expected);
}

TEST(AppendFile, FlushedRecordsAreThereWhileItIsOpen) {
  const support::TemporaryFolder folder;
  auto file = AppendFile::create(folder / "f");
  ASSERT_TRUE(file->append_line("one\n"));
  EXPECT_EQ(written_in(folder / "f"), "");
  ASSERT_TRUE(file->flush());
  EXPECT_EQ(written_in(folder / "f"), "one\n");
}

TEST(AppendFile, AFullDiskCostsNoWholeRecord) {
  const support::TemporaryFolder folder;
  for (const rlim_t room : {0U, 5U, 6U, 7U, 300'001U}) {
    auto file = AppendFile::create(folder / "f");
    ASSERT_TRUE(file);
    Result<void> result;
    {
      const SmallDisk disk(room);
      for (int i = 0; i < 100'000 && result; ++i) result = file->append_line("abcde\n");
      if (result) result = file->flush();
    }
    ASSERT_FALSE(result) << room;
    EXPECT_EQ(result.error().code, Errc::kIo);
    EXPECT_EQ(result.error().offset, room / 6 * 6) << room;
    EXPECT_THAT(result.error().detail, ::testing::Not(HasSubstr("kept"))) << "its owner decides";
    EXPECT_EQ(fs::file_size(folder / "f"), room / 6 * 6) << room;
    EXPECT_FALSE(file->append_line("abcde\n")) << "the error stays, although the disk has room again";
    EXPECT_TRUE(file->buffer().empty()) << "and what cannot be written is not kept in memory";
    EXPECT_FALSE(file->close());
    EXPECT_EQ(fs::file_size(folder / "f"), room / 6 * 6) << room;
  }
}

TEST(AppendFile, AFullDeviceIsSaidAtTheEndAtTheLatest) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  auto file = AppendFile::create("/dev/full");
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append_line("x\n"));
  const auto closed = file->close();
  ASSERT_FALSE(closed);
  EXPECT_THAT(closed.error().detail, HasSubstr("No space left"));
}

TEST(AppendFile, NoFolderNoFile) { EXPECT_FALSE(AppendFile::create("/nonexistent/f")); }

TEST(AppendFile, MovedFromIsClosed) {
  const support::TemporaryFolder folder;
  auto first = AppendFile::create(folder / "a"), second = AppendFile::create(folder / "b");
  ASSERT_TRUE(second->append_line("lost?\n"));
  *second = std::move(*first);
  EXPECT_EQ(written_in(folder / "b"), "lost?\n");
  EXPECT_FALSE(first->close());
  ASSERT_TRUE(second->append_line("a\n"));
  ASSERT_TRUE(second->close());
  EXPECT_EQ(written_in(folder / "a"), "a\n");
}

}  // namespace
}  // namespace cairn
