// SPDX-License-Identifier: Apache-2.0
#include "hal/files/input_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <string>

#include "hal/files/file.hpp"
#include "hal/files/line_file.hpp"
#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

/// A FIFO that nobody writes to: opening it for reading waits for ever.
std::string fifo_in(const support::TemporaryFolder& folder) {
  const std::string path = folder / "fifo";
  EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
  return path;
}

TEST(InputFile, GivesARegularFileInPieces) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomic(folder / "a", "12345"));
  auto file = InputFile::open(folder / "a").value();
  EXPECT_EQ(file.size(), 5U);
  std::array<std::byte, 3> piece{};
  EXPECT_EQ(file.read(piece).value(), 3U);
  EXPECT_EQ(file.read(piece).value(), 2U);
  EXPECT_EQ(file.read(piece).value(), 0U);
  EXPECT_EQ(InputFile::open(folder / "none").error().code, Errc::kNotFound);
}

TEST(InputFile, RefusesWhatIsNoRegularFileAtOnce) {
  const support::TemporaryFolder folder;
  const std::string socket = folder / "socket";
  const support::AbandonedSocket left_behind(socket);
  for (const std::string& path : {fifo_in(folder), socket, std::string("/dev/zero"), std::string(folder.path())}) {
    const auto refused = InputFile::open(path);
    ASSERT_FALSE(refused) << path;
    EXPECT_EQ(refused.error().code, Errc::kUnsupported) << path;
    EXPECT_EQ(refused.error().where, path);
    EXPECT_FALSE(refused.error().detail.empty()) << "the remedy";
    EXPECT_FALSE(read_file(path, 10));
    EXPECT_FALSE(LineFile::open(path, 10));
    EXPECT_FALSE(open_input_stream(path));
  }
}

// `cat map.cairn | cairn map info /dev/stdin`
TEST(InputFile, RefusesAPipeBehindAName) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const auto refused = InputFile::open("/proc/self/fd/" + std::to_string(ends[0]));
  EXPECT_EQ(refused.error().code, Errc::kUnsupported);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(InputFile, BecomesAStream) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomic(folder / "a", "x"));
  auto file = InputFile::open(folder / "a").value();
  std::FILE* stream = file.release_as_stream().value();
  EXPECT_EQ(std::fgetc(stream), 'x');
  std::fclose(stream);
  EXPECT_EQ(open_input_stream(folder / "a").value().get(), 'x');
}

}  // namespace
}  // namespace cairn
