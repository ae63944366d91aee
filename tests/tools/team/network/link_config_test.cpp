// SPDX-License-Identifier: Apache-2.0
#include "tools/team/network/link_config.hpp"
#include "tests/support/places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace cairn::team_run {
namespace {

using ::testing::HasSubstr;

Result<LinkConfig> link_from(const std::string& yaml) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "link.yaml") << yaml;
  return load_link((folder / "link.yaml").string());
}

TEST(LinkConfig, KeysThatAreLeftOutKeepTheirDefaults) {
  LinkConfig expected;
  expected.loss = 0.5;
  expected.seed = 9;
  EXPECT_EQ(link_from("loss: 0.5\nseed: 9\n").value(), expected);
  EXPECT_EQ(load_link("radio").value(), LinkConfig{});
}

TEST(LinkConfig, TheFileOfTheProjectIsTheDefault) {
  EXPECT_EQ(load_link(places::source() / "config/links/radio.yaml").value(), LinkConfig{});
}

TEST(LinkConfig, CleanDoesNothing) {
  const LinkConfig clean = load_link("clean").value();
  EXPECT_EQ(clean.rate_bit_s + clean.loss + clean.delay_ms + clean.jitter_ms + clean.reorder + clean.duplicate, 0);
}

TEST(LinkConfig, AllFaultsAreSaidAtOnce) {
  const auto link = link_from("loss: 1.5\ndelay_ms: -3\nbandwidth: 7\n");
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, Errc::kInvalidConfig);
  for (const char* what : {"loss", "delay_ms", "bandwidth"}) EXPECT_THAT(link.error().detail, HasSubstr(what));
}

TEST(LinkConfig, AFileThatIsNotThereIsAnError) { EXPECT_FALSE(load_link("no/such/link.yaml")); }

TEST(LinkConfig, ItsYamlIsItself) {
  LinkConfig link{1e5, 100, 0.1, 20, 5, 0.02, 0.3, 77}, again;
  config::Section section, other;
  declare(section, link);
  declare(other, again);
  ASSERT_TRUE(config::parse(config::to_yaml(section), "link.yaml", other));
  EXPECT_EQ(again, link);
}

TEST(LinkConfigFile, OneThatIsNotThereIsAWrongArgument) {
  const auto link = load_link("/nowhere/link.yaml");
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(link.error().where, "/nowhere/link.yaml");
}

}  // namespace
}  // namespace cairn::team_run
