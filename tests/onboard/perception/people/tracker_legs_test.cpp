// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "onboard/perception/people/tracker.hpp"
#include "tests/onboard/perception/people/tracker_rig.hpp"

namespace cairn::people {
namespace {

using test::TrackerTest;

using TrackerLegsTest = TrackerTest;

TEST_F(TrackerLegsTest, KeepAPersonWhomADeskHides) {
  entered_ = 1;
  for (int i = 0; i < 4; ++i) {
    scan({{3, 0.1 * i}});
    hear({Verdict::kPerson});
  }
  low_ = true;
  entered_ = 0;
  for (int i = 4; i < 60; ++i) scan({{3, 0.1 * i}});
  ASSERT_EQ(tracker_.people().size(), 1U);
  EXPECT_TRUE(tracker_.people()[0].seen);
}

TEST_F(TrackerLegsTest, FindAPersonAgainWhereNothingStoodBefore) {
  for (const float known : {0.0F, 0.6F}) {
    tracker_.clear();
    low_ = false;
    entered_ = 1;
    known_ = 0;
    for (int i = 0; i < 4; ++i) {
      scan({{3, 0}});
      hear({Verdict::kPerson});
    }
    for (int i = 0; i < 8; ++i) scan({});
    ASSERT_TRUE(tracker_.people().empty()) << "hidden";
    low_ = true;
    entered_ = 0;
    known_ = known;
    scan({{3.5, 0.3}});
    EXPECT_EQ(tracker_.people().size(), known > 0.3F ? 0U : 1U) << known;
  }
}

TEST_F(TrackerLegsTest, BeginATrackOnlyWhereTheyCame) {
  low_ = through_ = true;
  for (int i = 0; i < 20; ++i) scan({{3, 0.1 * i}});
  EXPECT_TRUE(tracker_.people().empty());
  entered_ = 1;
  for (int i = 0; i < 20; ++i) scan({{3, 0.1 * i}});
  EXPECT_EQ(tracker_.people().size(), 1U);
}

}  // namespace
}  // namespace cairn::people
