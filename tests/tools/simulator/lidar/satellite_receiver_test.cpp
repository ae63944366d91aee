// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/satellite_receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/velodyne/nmea.hpp"
#include "fusion/team/site_fit.hpp"

namespace cairn::simulator {
namespace {

using std::chrono::seconds;

/// East at 1 m/s.
struct EastwardTrack final : Track {
  [[nodiscard]] Time start() const override { return Time{seconds(50)}; }
  [[nodiscard]] SE3 T_world_base(Time t) const override {
    return SE3::from_xyz_rpy((Vector6() << to_seconds(t - start()), 7, 0, 0, 0, 0).finished());
  }
};

constexpr std::int64_t kUtcNs = 1'700'000'000LL * 1'000'000'000;

Eigen::Vector2d place_said(const SatelliteReceiver& receiver, Time t) {
  const auto fix = velodyne::parse_nmea(receiver.sentence(t));
  EXPECT_TRUE(fix && fix->valid && fix->place);
  const team::SiteOrigin origin{SatelliteReceiver::kLatitude_deg, SatelliteReceiver::kLongitude_deg};
  return origin.to_site(fix->place->latitude_deg, fix->place->longitude_deg);
}

TEST(SatelliteReceiver, SaysWhereTheRobotWasAtTheLastSecond) {
  const EastwardTrack track;
  const SatelliteReceiver receiver(track, 0.01, kUtcNs, 3);
  for (const double s : {0.0, 1.0, 30.0}) {
    const auto at = place_said(receiver, track.start() + from_seconds(s + 0.4));
    EXPECT_LT((at - Eigen::Vector2d(s, 7)).norm(), 0.06) << s;
  }
  EXPECT_EQ(receiver.sentence(track.start() + from_seconds(5.1)), receiver.sentence(track.start() + from_seconds(5.9)));
}

TEST(SatelliteReceiver, ItsErrorIsAnOffsetOfTheSizeThatWasAskedFor) {
  const EastwardTrack track;
  double squares = 0, steps = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const SatelliteReceiver receiver(track, 3, kUtcNs, seed);
    const auto error = [&](int s) {
      return Eigen::Vector2d(place_said(receiver, track.start() + seconds(s)) - Eigen::Vector2d(s, 7));
    };
    squares += error(10).squaredNorm() / 2 / 200;
    steps += (error(11) - error(10)).squaredNorm() / 2 / 200;
  }
  EXPECT_NEAR(std::sqrt(squares), 3, 0.4);
  EXPECT_LT(std::sqrt(steps), 0.6) << "it changes slowly";
}

TEST(SatelliteReceiver, WithoutAnAntennaItIsWhereItAlwaysWas) {
  const EastwardTrack track;
  const SatelliteReceiver receiver(track, 0, kUtcNs, 3);
  EXPECT_NE(receiver.sentence(track.start()).find(",A,5155.4400,N,00424.1200,E,"), std::string::npos);
}

}  // namespace
}  // namespace cairn::simulator
