// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/sensor_kind.hpp"

#include <gtest/gtest.h>

namespace cairn::recording {
namespace {

TEST(SensorKind, EveryNameIsThatOfItsKind) {
  for (const SensorKindRow& row : kSensorKinds) EXPECT_EQ(parse_sensor_kind(to_string(row.kind)), row.kind);
  EXPECT_EQ(to_string(kPeers), "peers");
  EXPECT_EQ(parse_sensor_kind("sonar"), std::nullopt);
  EXPECT_EQ(parse_sensor_kind(""), std::nullopt);
}

TEST(SensorKind, TheListForMessagesHoldsThemAll) {
  EXPECT_EQ(list_of_sensor_kinds(), "velodyne, scans, camera, thermal, depth, drive, gpio, peers or commands");
}

TEST(SensorKind, ATableHasOneRowPerKindInTheirOrder) {
  struct Row {
    SensorKind kind;
  };
  EXPECT_FALSE(one_row_per_kind(std::array{Row{kVelodyne}}));
  EXPECT_FALSE(one_row_per_kind(std::array{Row{kScans}, Row{kVelodyne}, Row{kCamera}, Row{kThermal}, Row{kDepth},
                                           Row{kDrive}, Row{kGpio}, Row{kPeers}, Row{kCommands}}));
}

TEST(SensorKind, ThreeOfThemArePictures) {
  int pictures = 0;
  for (const SensorKindRow& row : kSensorKinds) pictures += is_picture_kind(row.kind) ? 1 : 0;
  EXPECT_EQ(pictures, 3);
  EXPECT_TRUE(is_picture_kind(kDepth));
}

}  // namespace
}  // namespace cairn::recording
