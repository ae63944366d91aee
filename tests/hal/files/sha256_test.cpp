// SPDX-License-Identifier: Apache-2.0
#include "hal/files/sha256.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string_view>

#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

std::string sum(std::string_view text) {
  Sha256 s;
  s.update(std::as_bytes(std::span(text)));
  return s.finish();
}

// FIPS 180-2, appendix B.
TEST(Sha256, GivesThePublishedSums) {
  EXPECT_EQ(sum(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sum("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sum("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sum(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256OfFiles, IsTheSumOfTheirBytesOneAfterTheOther) {
  const support::TemporaryFolder folder;
  const std::string long_text(200'001, 'x');
  std::ofstream(folder / "a") << "ab";
  std::ofstream(folder / "b") << "c" << long_text;
  std::ofstream(folder / "empty") << "";
  const std::array files{folder / "a", folder / "empty", folder / "b"};
  EXPECT_EQ(sha256_of_files(files).value(), sum("abc" + long_text));
  const std::array missing{folder / "a", folder / "none"};
  ASSERT_FALSE(sha256_of_files(missing).has_value());
  EXPECT_THAT(to_string(sha256_of_files(missing).error()), testing::HasSubstr("none"));
  const std::array unreadable{folder.path()};
  EXPECT_FALSE(sha256_of_files(unreadable).has_value());
}

}  // namespace
}  // namespace cairn
