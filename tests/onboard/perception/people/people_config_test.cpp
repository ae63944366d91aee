// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/people_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cairn::people {
namespace {

using ::testing::HasSubstr;

TEST(PeopleConfig, ReadsItsKeys) {
  PeopleConfig config;
  config::Section section;
  declare(section, config);
  ASSERT_TRUE(config::parse("follow: always\nmovers: false\nthermal: {recall: 0.6}\n", "p.yaml", section));
  EXPECT_EQ(config.follow, "always");
  EXPECT_FALSE(config.movers);
  EXPECT_EQ(config.thermal.recall, 0.6);
  EXPECT_EQ(config.visible.recall, DetectorTrust().recall);
}

TEST(PeopleConfig, NamesWhatIsOutOfBounds) {
  PeopleConfig config;
  config::Section section;
  declare(section, config);
  const auto parsed = config::parse("follow: sometimes\nvisible: {false_share: 0}\n", "p.yaml", section);
  ASSERT_FALSE(parsed);
  EXPECT_THAT(to_string(parsed.error()), HasSubstr("follow"));
  EXPECT_THAT(to_string(parsed.error()), HasSubstr("false_share"));
}

}  // namespace
}  // namespace cairn::people
