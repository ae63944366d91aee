// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/object_dictionary.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

using namespace drive;
using canopen::Object;
using canopen::SdoRequest;
using canopen::SdoResponse;
using Kind = SdoResponse::Kind;

class Dictionary : public testing::Test {
 protected:
  SdoResponse read(Object object) { return objects.answer({SdoRequest::Kind::kRead, object, 0, 0}, false); }
  SdoResponse write(Object object, std::uint32_t value, std::uint8_t bytes, bool operational = false) {
    return objects.answer({SdoRequest::Kind::kWrite, object, value, bytes}, operational);
  }
  ObjectDictionary objects{0x300, 0x4644, 10'000};
};

TEST_F(Dictionary, ANodeWithoutPowerHasNoObjects) {
  EXPECT_FALSE(ObjectDictionary().has(cia402::kMode));
  EXPECT_EQ(ObjectDictionary().value(cia402::kVendor), 0U);
}

TEST_F(Dictionary, IdentityAndRampsAreThoseItWasMadeWith) {
  EXPECT_EQ(read(cia402::kVendor).value, 0x300U);
  EXPECT_EQ(read(cia402::kProduct).value, 0x4644U);
  EXPECT_EQ(read(cia402::kAcceleration).value, 10'000U);
  EXPECT_EQ(read(cia402::kQuickStopDeceleration).value, 30'000U);
}

TEST_F(Dictionary, AReadGivesTheValueWithItsLength) {
  const auto response = read(cia402::kStatusword);
  EXPECT_EQ(response.kind, Kind::kValue);
  EXPECT_EQ(response.object, cia402::kStatusword);
  EXPECT_EQ(response.bytes, 2);
}

TEST_F(Dictionary, AGrantedWriteIsReadBack) {
  EXPECT_EQ(write(cia402::kTargetVelocity, 0xFFFFFF00U, 4).kind, Kind::kWritten);
  EXPECT_EQ(read(cia402::kTargetVelocity).value, 0xFFFFFF00U);
}

TEST_F(Dictionary, ARefusedWriteSaysWhyAndChangesNothing) {
  const Object nothing{0x2000, 3};
  EXPECT_EQ(read(nothing).value, canopen::kAbortNoObject);
  EXPECT_EQ(write(nothing, 1, 4).value, canopen::kAbortNoObject);
  EXPECT_EQ(write(cia402::kVendor, 1, 4).value, canopen::kAbortReadOnly);
  EXPECT_EQ(write(cia402::kMode, 3, 2).value, 0x06070010U) << "another length";
  EXPECT_EQ(objects.value(cia402::kVendor), 0x300U);
  EXPECT_EQ(objects.value(cia402::kMode), 0U);
  EXPECT_FALSE(objects.has(nothing));
}

TEST_F(Dictionary, MappingsAreClosedWhileTheNodeIsOperational) {
  const Object entries{0x1600, 0};
  EXPECT_EQ(write(entries, 1, 1, true).value, canopen::kAbortState);
  EXPECT_EQ(write(entries, 1, 1, false).kind, Kind::kWritten);
  EXPECT_EQ(write(cia402::kMode, 3, 1, true).kind, Kind::kWritten) << "no mapping";
}

TEST_F(Dictionary, TheDeviceItselfWritesWhatIsReadOnlyOnTheBus) {
  objects.put(cia402::kErrorCode, 0x2310);
  EXPECT_EQ(read(cia402::kErrorCode).value, 0x2310U);
}

}  // namespace
}  // namespace cairn::simulator
