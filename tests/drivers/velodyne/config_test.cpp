// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/config.hpp"

#include <gtest/gtest.h>

#include "drivers/velodyne/models.hpp"

namespace cairn::velodyne {
namespace {

TEST(Config, DefaultsAreSoundAndSurviveTheFile) {
  Config c;
  EXPECT_TRUE(check(c));
  config::Section section;
  declare(section, c);
  c.model = "HDL-32E";
  c.cut_angle_deg = 180;
  const std::string text = config::to_yaml(section);
  Config again;
  config::Section read;
  declare(read, again);
  const auto parsed = config::parse(text, "robot.yaml", read);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(again.model, "HDL-32E");
  EXPECT_EQ(again.cut_angle_deg, 180);
  EXPECT_EQ(config::to_yaml(read), text);
}

TEST(Config, EveryModelNameIsAccepted) {
  for (const Model& m : models()) {
    Config c;
    config::Section section;
    declare(section, c);
    EXPECT_TRUE(config::parse("model: " + std::string(m.name), "f", section)) << m.name;
    EXPECT_TRUE(check(c));
  }
  Config c;
  config::Section section;
  declare(section, c);
  EXPECT_FALSE(config::parse("model: VLP-64", "f", section));
}

TEST(Config, ABoxThatIsUpsideDownIsOneFault) {
  Config c;
  c.body_box_m = {1, 1, 1, 0, 0, 0};
  EXPECT_EQ(check(c).error().detail, "body_box_m: the lower corner is above the upper one");
}

TEST(Config, AllFaultsAreReportedAtOnce) {
  Config c;
  c.model = "VLP-64";
  c.position_port = c.data_port;
  c.min_range_m = 50;
  c.max_range_m = 40;
  c.source_address = "192.168.1";
  c.bind_address = "localhost";
  c.body_box_m = {1, 0, 0, 0, 0, 0};
  c.field_of_view_deg = {1};
  const auto sound = check(c);
  ASSERT_FALSE(sound);
  EXPECT_EQ(sound.error().code, Errc::kInvalidConfig);
  for (const char* word : {"VLP-64", "VLP-32C", "position_port", "min_range_m", "source_address", "bind_address",
                           "body_box_m", "field_of_view_deg"})
    EXPECT_NE(sound.error().detail.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace cairn::velodyne
