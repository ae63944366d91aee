// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/record.hpp"

#include <gtest/gtest.h>

namespace cairn::clients {
namespace {

std::vector<std::byte> record_of(std::size_t body) {
  std::vector<std::byte> out;
  begin_record(RecordKind::kPose, 7, out);
  out.insert(out.end(), body, std::byte{0x5A});
  end_record(out);
  return out;
}

TEST(Record, ComesBackAsItWasSent) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100}, Record::kMaxBody}) {
    const auto message = record_of(size);
    const auto record = decode_record(message);
    ASSERT_TRUE(record) << to_string(record.error());
    EXPECT_EQ(record->kind, RecordKind::kPose);
    EXPECT_EQ(record->sequence, 7U);
    EXPECT_EQ(record->body.size(), size);
  }
}

TEST(Record, AnyFlippedBitIsRefused) {
  const auto message = record_of(5);
  for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
    auto damaged = message;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_FALSE(decode_record(damaged)) << bit;
  }
}

TEST(Record, SaysWhatIsWrong) {
  auto message = record_of(5);
  EXPECT_EQ(decode_record(std::span(message).first(15)).error().code, Errc::kTruncated);
  EXPECT_EQ(decode_record(record_of(Record::kMaxBody + 1)).error().code, Errc::kLimit);
  EXPECT_EQ(decode_record(std::span(message).first(18)).error().code, Errc::kMalformed);
  message[3] = std::byte{9};
  EXPECT_EQ(decode_record(message).error().code, Errc::kUnsupported);
}

}  // namespace
}  // namespace cairn::clients
