// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/stream/people_command.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "tests/tools/cli/stream/core_stand_in.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

void one_walks(app::StreamOutlets& outlets, int tick) {
  app::PeopleNews* news = outlets.people.back();
  if (news == nullptr) return;
  news->stamp = Time{std::chrono::milliseconds(100 * (tick + 1))};
  news->people.resize(1);
  news->people[0].id = 3;
  news->people[0].position = {1, 2};
  news->people[0].velocity = {0, 1.5};
  outlets.people.push();
}
void a_peer_sees_one(app::StreamOutlets& outlets, int /*tick*/) {
  app::PeopleNews* news = outlets.team_people.back();
  if (news == nullptr) return;
  news->robot = 2;
  news->people.resize(1);
  news->people[0].id = 7;
  news->people[0].seen = true;
  outlets.team_people.push();
}
void nobody_speaks(app::StreamOutlets& /*outlets*/, int /*tick*/) {}

TEST(PeopleCommand, PrintsALineForEachScan) {
  const Outcome o = test::run_beside_core(add_people_command, {"people", "--seconds", "0.2"}, one_walks);
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("1 people  #3 at 1.00 2.00 m, 1.5 m/s (hidden)"));
}

TEST(PeopleCommand, JsonSaysTheSame) {
  const Outcome o = test::run_beside_core(add_people_command, {"people", "--seconds", "0.2", "--json"}, one_walks);
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  std::istringstream lines(o.out);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto json = nlohmann::json::parse(line, nullptr, false);
  ASSERT_TRUE(json.is_object()) << line;
  EXPECT_EQ(json["people"][0]["id"], 3);
  EXPECT_EQ(json["people"][0]["velocity"], (std::vector<double>{0, 1.5}));
  EXPECT_EQ(json["people"][0]["seen"], false);
}

TEST(PeopleCommand, ThoseOfPeersAreNamedByRobot) {
  const Outcome o =
      test::run_beside_core(add_people_command, {"people", "--team", "--seconds", "0.2"}, a_peer_sees_one);
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("robot 2: 1 people  #7 at 0.00 0.00 m"));
}

TEST(PeopleCommand, SaysThatNobodyIsFollowed) {
  const Outcome o = test::run_beside_core(add_people_command, {"people", "--seconds", "0.1"}, nobody_speaks);
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("nothing was said of people in time"));
}

}  // namespace
}  // namespace cairn::cli
