// SPDX-License-Identifier: Apache-2.0
#include "hal/files/line_file.hpp"

#include <gtest/gtest.h>

#include "hal/files/file.hpp"

namespace cairn {
namespace {

TEST(LineFile, ReadsEveryLineInBoundedMemory) {
  const auto path = std::filesystem::path(testing::TempDir()) / "cairn_line_file.txt";
  ASSERT_TRUE(write_file_atomic(path, std::string_view("one\r\n\nthree is too long\nend\0!", 29)));
  auto file = LineFile::open(path, 8).value();
  EXPECT_EQ(file.next().value(), "one");
  EXPECT_EQ(file.next().value(), "");
  const auto third = file.next();
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, Errc::kLimit);
  EXPECT_EQ(third.error().where, path.string() + ":3");
  EXPECT_EQ(file.next().value(), std::string_view("end\0!", 5));
  EXPECT_FALSE(file.next().value());
  EXPECT_EQ(LineFile::open(path / "none", 8).error().code, Errc::kIo);
  std::filesystem::remove(path);
  EXPECT_EQ(LineFile::open(path, 8).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn
