// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/picture.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

std::vector<std::byte> some_bytes(std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 7);
  return bytes;
}

TEST(PicturePart, PartsMakeThePicture) {
  const auto bytes = some_bytes(100'000);
  PicturePart part{.stamp = Time{Duration{77}}, .camera = 2};
  std::vector<std::byte> got;
  int parts = 0;
  for (; part.first < bytes.size(); ++parts) {
    std::vector<std::byte> body;
    const std::uint32_t taken = encode(part, bytes, body);
    ASSERT_LE(body.size(), Record::kMaxBody);
    const auto decoded = decode_picture(body);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(decoded->stamp, part.stamp);
    EXPECT_EQ(decoded->camera, 2);
    EXPECT_EQ(decoded->total, bytes.size());
    EXPECT_EQ(decoded->first, part.first);
    got.insert(got.end(), decoded->bytes.begin(), decoded->bytes.end());
    part.first += taken;
  }
  EXPECT_EQ(parts, 4);
  EXPECT_EQ(got, bytes);
}

TEST(PicturePart, IsExact) {
  std::vector<std::byte> body;
  encode(PicturePart{.camera = 1}, some_bytes(30), body);
  test::expect_exact(body, decode_picture);
}

TEST(PicturePart, ALargerPictureThanAnyIsCut) {
  std::vector<std::byte> body;
  const PicturePart last{.first = PicturePart::kMaxBytes};
  EXPECT_EQ(encode(last, some_bytes(PicturePart::kMaxBytes + 5), body), 0U);
}

}  // namespace
}  // namespace cairn::clients
