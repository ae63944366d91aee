// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/pdo_mapping.hpp"

#include <gmock/gmock.h>

namespace cairn::simulator {
namespace {

using namespace drive;
using canopen::Object;
using testing::ElementsAre;

constexpr std::uint8_t kNode = 5;

/// An entry of a mapping: the object and its length in bits.
std::uint32_t entry(Object o, unsigned bits) {
  return static_cast<std::uint32_t>(o.index) << 16U | static_cast<std::uint32_t>(o.sub) << 8U | bits;
}

class PdoMapping : public testing::Test {
 protected:
  void map(std::uint16_t base, std::uint32_t id, const std::vector<std::uint32_t>& entries) {
    const auto mapping = static_cast<std::uint16_t>(base + 0x200U);
    objects.put({base, 1}, id);
    objects.put({mapping, 0}, static_cast<std::uint32_t>(entries.size()));
    for (std::size_t i = 0; i < entries.size(); ++i)
      objects.put({mapping, static_cast<std::uint8_t>(i + 1)}, entries[i]);
  }
  void take(const CanFrame& frame) {
    unpack_rpdos(frame, objects, [this](Object object) { written.push_back(object.index); });
  }
  std::vector<CanFrame> sent() const {
    std::vector<CanFrame> out;
    pack_tpdos(objects, out);
    return out;
  }

  ObjectDictionary objects{1, 2, 100};
  std::vector<unsigned> written;
};

TEST_F(PdoMapping, AsItComesUpNothingIsMapped) {
  EXPECT_TRUE(sent().empty());
  take(cia402::rpdo1(kNode, {0x0F, 1000}));
  EXPECT_TRUE(written.empty());
}

TEST_F(PdoMapping, WhatTheMasterSendsIsWrittenInTheOrderOfTheMapping) {
  map(0x1400, canopen::kRpdo1 + kNode, {entry(cia402::kControlword, 16), entry(cia402::kTargetVelocity, 32)});
  take(cia402::rpdo1(kNode, {0x0F, -1000}));
  EXPECT_THAT(written, ElementsAre(0x6040U, 0x60FFU));
  EXPECT_EQ(objects.value(cia402::kControlword), 0x0FU);
  EXPECT_EQ(static_cast<std::int32_t>(objects.value(cia402::kTargetVelocity)), -1000);
  take(cia402::rpdo1(kNode + 1, {0x06, 5}));
  EXPECT_EQ(objects.value(cia402::kControlword), 0x0FU) << "another node's frame";
}

TEST_F(PdoMapping, AShortFrameEndsBeforeTheObjectThatItCutsOff) {
  map(0x1400, canopen::kRpdo1 + kNode, {entry(cia402::kControlword, 16), entry(cia402::kTargetVelocity, 32)});
  CanFrame frame = cia402::rpdo1(kNode, {0x0F, 1000});
  frame.length = 5;
  take(frame);
  EXPECT_THAT(written, ElementsAre(0x6040U));
  EXPECT_EQ(objects.value(cia402::kTargetVelocity), 0U);
}

TEST_F(PdoMapping, AMappingOfWhatDoesNotExistEndsThere) {
  map(0x1400, canopen::kRpdo1 + kNode, {entry({0x2000, 0}, 16), entry(cia402::kTargetVelocity, 32)});
  take(cia402::rpdo1(kNode, {0x0F, 1000}));
  EXPECT_TRUE(written.empty());
}

TEST_F(PdoMapping, AnEntryThatIsLongerThanAnObjectIsNotSent) {
  map(0x1800, canopen::kTpdo1 + kNode, {entry(cia402::kPosition, 64)});
  EXPECT_TRUE(sent().empty());
}

TEST_F(PdoMapping, WhatTheNodeSendsIsReadByTheMaster) {
  map(0x1800, canopen::kTpdo1 + kNode,
      {entry(cia402::kStatusword, 16), entry(cia402::kModeDisplay, 8), entry(cia402::kErrorCode, 16)});
  objects.put(cia402::kStatusword, 0x0237);
  objects.put(cia402::kModeDisplay, 3);
  objects.put(cia402::kErrorCode, 0x8130);
  const auto frames = sent();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].id, canopen::kTpdo1 + kNode);
  const auto status = cia402::decode_tpdo1(frames[0]);
  ASSERT_TRUE(status);
  EXPECT_EQ(*status, (cia402::Status{0x0237, 3, 0x8130}));
}

TEST_F(PdoMapping, AMappingOfMoreThanAFrameHoldsSendsNothing) {
  map(0x1800, canopen::kTpdo1 + kNode,
      {entry(cia402::kPosition, 32), entry(cia402::kVelocity, 32), entry(cia402::kStatusword, 16)});
  EXPECT_TRUE(sent().empty());
}

}  // namespace
}  // namespace cairn::simulator
