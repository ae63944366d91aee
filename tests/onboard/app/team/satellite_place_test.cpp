// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/satellite_place.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

using std::chrono::seconds;

SatelliteProfile profile() { return {.origin_latitude_deg = 51.9, .origin_longitude_deg = 4.4, .sigma_m = 2}; }

/// A robot that drives north at 1 m/s; its odom's x points there.
struct Drive {
  SatellitePlace place{profile()};
  int told = 0;
  std::optional<UncertainPose> last;

  void go(int from_s, int to_s) {
    const team::SiteOrigin origin{51.9, 4.4};
    for (int s = from_s; s < to_s; ++s) {
      const Eigen::Vector2d geo = origin.from_site({5, 10.0 + s});
      const GeoFix fix{Time{seconds(100 + s)}, geo.x(), geo.y()};
      const auto T = place.take(fix, SE3::from_xyz_rpy((Vector6() << s, 0, 0, 0, 0, 0).finished()));
      if (T) last = T;
      told += T ? 1 : 0;
    }
  }
};

TEST(SatellitePlace, TellsThePlaceAtOnceAndTheHeadingAfterSomeMetres) {
  Drive drive;
  drive.go(0, 1);
  ASSERT_TRUE(drive.last);
  EXPECT_FALSE(team::knows_yaw(*drive.last));
  drive.go(1, 30);
  EXPECT_TRUE(team::knows_yaw(*drive.last));
  const SE3 truth = SE3::from_xyz_rpy((Vector6() << 5, 10, 0, 0, 0, M_PI / 2).finished());
  EXPECT_LT((drive.last->mean.inverse() * truth).log().norm(), 0.01);
}

TEST(SatellitePlace, TellsOnlyWhatIsNews) {
  Drive drive;
  drive.go(0, 600);
  EXPECT_EQ(drive.place.figures().fixes, 600U);
  EXPECT_GE(drive.told, 3);
  EXPECT_LE(drive.told, 15) << "each time it is known better by a third";
}

TEST(SatellitePlace, BeginsAnewWithTheMap) {
  Drive drive;
  drive.go(0, 60);
  drive.place.begin();
  EXPECT_FALSE(drive.place.figures().T_site_odom);
  drive.go(60, 61);
  EXPECT_FALSE(team::knows_yaw(*drive.last));
}

TEST(SatellitePlace, WithoutAnOriginItTellsNothing) {
  SatellitePlace place{SatelliteProfile()};
  EXPECT_FALSE(place.take({Time{seconds(1)}, 51.9, 4.4}, SE3()));
  EXPECT_EQ(place.figures().fixes, 0U);
}

TEST(SatellitePlace, AnOriginOnAnotherContinentIsNoticed) {
  SatellitePlace place{profile()};
  EXPECT_FALSE(place.take({Time{seconds(1)}, -33, 151}, SE3()));
  EXPECT_EQ(place.figures().too_far, 1U);
}

}  // namespace
}  // namespace cairn::app
