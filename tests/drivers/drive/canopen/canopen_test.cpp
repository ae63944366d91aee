// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/canopen.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <sstream>

#include "drivers/drive/can/candump.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "tests/drivers/drive/files.hpp"

namespace cairn::drive::canopen {
namespace {

TEST(CanOpen, MessagesAreThoseOfTheStandard) {
  EXPECT_EQ(nmt(NmtCommand::kStart, 1), make_frame(0x000, {0x01, 0x01}));
  EXPECT_EQ(sync(), make_frame(0x080, {}));
  EXPECT_EQ(heartbeat(0x7F, NmtState::kOperational), make_frame(0x77F, {0x05}));
  EXPECT_EQ(sdo_read(2, {0x1018, 1}), make_frame(0x602, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  EXPECT_EQ(sdo_write(1, {0x60FF, 0}, 0xFFFFFA68, 4), make_frame(0x601, {0x23, 0xFF, 0x60, 0, 0x68, 0xFA, 0xFF, 0xFF}));
  EXPECT_EQ(sdo_write(1, {0x6007, 0}, 1, 2), make_frame(0x601, {0x2B, 0x07, 0x60, 0, 1, 0, 0, 0}));
  EXPECT_EQ(sdo_write(1, {0x1600, 0}, 2, 1), make_frame(0x601, {0x2F, 0x00, 0x16, 0, 2, 0, 0, 0}));
  EXPECT_EQ(sdo_abort(1, {0x1000, 0}, kAbortTimeout), make_frame(0x601, {0x80, 0x00, 0x10, 0, 0, 0, 0x04, 0x05}));
}

TEST(CanOpen, SdoEncodeThenDecodeIsIdentity) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Object object{static_cast<std::uint16_t>(random()), static_cast<std::uint8_t>(random())};
    const auto bytes = static_cast<std::uint8_t>(1 + random() % 4);
    const std::uint32_t value = static_cast<std::uint32_t>(bytes == 4 ? random() : random() % (1U << 8U * bytes));
    const auto write = decode_sdo_request(sdo_write(5, object, value, bytes)).value();
    EXPECT_EQ(write.kind, SdoRequest::Kind::kWrite);
    EXPECT_EQ(write.object, object);
    EXPECT_EQ(write.value, value);
    EXPECT_EQ(write.bytes, bytes);
    const auto read = decode_sdo_response(sdo_response(5, {SdoResponse::Kind::kValue, object, value, bytes})).value();
    EXPECT_EQ(read.object, object);
    EXPECT_EQ(read.value, value);
    EXPECT_EQ(read.bytes, bytes);
  }
}

TEST(CanOpen, ValuesAreSignExtended) {
  EXPECT_EQ((SdoResponse{SdoResponse::Kind::kValue, {}, 0xFF, 1}.as_signed()), -1);
  EXPECT_EQ((SdoResponse{SdoResponse::Kind::kValue, {}, 0x8000, 2}.as_signed()), -32768);
  EXPECT_EQ((SdoResponse{SdoResponse::Kind::kValue, {}, 0xFFFFFA68, 4}.as_signed()), -1432);
}

TEST(CanOpen, RefusesWhatIsMalformed) {
  EXPECT_EQ(decode_heartbeat(make_frame(0x701, {})).error().code, Errc::kMalformed);
  EXPECT_EQ(decode_heartbeat(make_frame(0x701, {0x33})).error().code, Errc::kMalformed);
  EXPECT_EQ(decode_emergency(make_frame(0x81, {1, 2, 3})).error().code, Errc::kMalformed);
  EXPECT_EQ(decode_sdo_response(make_frame(0x581, {0x60, 0, 0})).error().code, Errc::kMalformed);
  EXPECT_EQ(decode_sdo_response(make_frame(0x581, {0x41, 8, 0x10, 0, 9, 0, 0, 0})).error().code, Errc::kUnsupported);
}

TEST(CanOpen, EmergencyIsDecoded) {
  const auto message = decode_emergency(make_frame(0x81, {0x10, 0x23, 0x02, 1, 2, 3, 4, 5})).value();
  EXPECT_EQ(message.code, 0x2310);
  EXPECT_EQ(message.error_register, 2);
  EXPECT_EQ(message.vendor[4], 5);
}

/// Every SDO answer of an excerpt: (node, index) → value of the last.
std::map<std::pair<unsigned, unsigned>, SdoResponse> answers(const std::string& text) {
  std::map<std::pair<unsigned, unsigned>, SdoResponse> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const auto parsed = parse_candump(line).value();
    if (!parsed || parsed->frame.id < 0x581 || parsed->frame.id > 0x5FF) continue;
    const auto response = decode_sdo_response(parsed->frame).value();
    found[{parsed->frame.id - kSdoResponse, response.object.index}] = response;
  }
  return found;
}

TEST(CanOpenData, VelocityExcerptDecodesAsItsFirstLineSays) {
  const auto path = test::can_data("cia402_simulated_drive_velocity.candump.txt");
  SKIP_WITHOUT(path);
  auto found = answers(test::read_text(path));
  for (const unsigned object : {0x60FEU, 0x6072U}) {
    const SdoResponse response = found[{1, object}];
    EXPECT_EQ(response.kind, SdoResponse::Kind::kAbort);
    EXPECT_EQ(response.value, kAbortReadOnly);
  }
  for (const unsigned node : {1U, 2U}) {
    const auto status = static_cast<std::uint16_t>(found[{node, 0x6041}].value);
    EXPECT_EQ(status, 0x0637);
    EXPECT_EQ(cia402::state_of(status), cia402::State::kOperationEnabled);
  }
  EXPECT_EQ((found[{1, 0x606C}].as_signed()), -1432);
  EXPECT_EQ((found[{2, 0x606C}].as_signed()), 954);
}

TEST(CanOpenData, BringUpExcerptTellsTheNodesIdentity) {
  const auto path = test::can_data("cia402_two_node_bringup.candump.txt");
  SKIP_WITHOUT(path);
  const std::string text = test::read_text(path);
  auto found = answers(text);
  std::istringstream in(text);
  int boot_ups = 0;
  for (std::string line; std::getline(in, line);) {
    const auto parsed = parse_candump(line).value();
    if (!parsed) continue;
    if (parsed->frame.is(0x701) || parsed->frame.is(0x702))
      boot_ups += decode_heartbeat(parsed->frame).value() == NmtState::kBootUp;
    if (parsed->frame.is(0x181)) {
      EXPECT_EQ(cia402::state_of(load_u16(parsed->frame, 0)), cia402::State::kFault);
    }
  }
  EXPECT_EQ(boot_ups, 2);
  for (const unsigned node : {1U, 2U}) {
    EXPECT_EQ((found[{node, 0x1000}].value), 0x00020192U);
    EXPECT_EQ((found[{node, 0x1018}].value), 0x4644U);
  }
}

}  // namespace
}  // namespace cairn::drive::canopen
