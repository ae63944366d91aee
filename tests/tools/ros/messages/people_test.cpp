// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/people.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

TEST(RosPeople, EachIsABodyAnArrowAndANumber) {
  client::PeopleMessage people;
  people.people.resize(2);
  people.people[1] = {.id = 7, .sightings = 3, .seen = true, .position_odom = {1, 2, 0.5}, .velocity_odom = {0, -1}};
  Arena arena;
  const Header header = header_of(Time{}, std::chrono::seconds(7), "odom", arena);
  const MarkerArray array = markers_of(people, header, arena);
  ASSERT_EQ(array.markers._length, 7U);
  const Marker* all = array.markers._buffer;
  EXPECT_EQ(all[0].action, 3) << "those of before go";
  EXPECT_STREQ(all[4].ns, "people");
  EXPECT_EQ(all[4].id, 7);
  EXPECT_EQ(all[4].type, 3);
  EXPECT_EQ(all[4].pose.position.x, 1);
  EXPECT_NEAR(all[4].pose.position.z, 0.5 + 0.85, 1e-9);
  EXPECT_STREQ(all[4].header.frame_id, "odom");
  EXPECT_GT(all[4].color.a, all[1].color.a) << "who is hidden is faint";
  ASSERT_EQ(all[5].points._length, 2U);
  EXPECT_EQ(all[5].points._buffer[1].y, 1);
  EXPECT_STREQ(all[6].text, "7");
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_STREQ(all[i].mesh_resource, "");
    EXPECT_STREQ(all[i].texture.format, "");
    EXPECT_STREQ(all[i].mesh_file.filename, "");
  }
}

TEST(RosPeople, ThoseOfATeammateHaveItsIdAndRemoveNobody) {
  client::PeopleMessage people;
  people.robot = 3;
  people.people.resize(1);
  Arena arena;
  const Header header = header_of(Time{}, {}, "odom", arena);
  const MarkerArray array = markers_of(people, header, arena);
  ASSERT_EQ(array.markers._length, 3U);
  for (unsigned i = 0; i < 3; ++i) EXPECT_EQ(array.markers._buffer[i].action, 0);
  EXPECT_STREQ(array.markers._buffer[0].ns, "people_3");
  people.people.clear();
  EXPECT_EQ(markers_of(people, header, arena).markers._length, 0U);
}

TEST(RosPeople, NobodyRemovesAll) {
  Arena arena;
  const Header header = header_of(Time{}, {}, "odom", arena);
  const MarkerArray array = markers_of({}, header, arena);
  ASSERT_EQ(array.markers._length, 1U);
  EXPECT_EQ(array.markers._buffer[0].action, 3);
}

}  // namespace
}  // namespace cairn::ros
