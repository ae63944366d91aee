// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/thermal_stream.hpp"

#include <cstring>
#include <memory>
#include <string>

#include "tests/drivers/camera/frames.hpp"
#include "tests/onboard/app/streams/streams_rig.hpp"

namespace cairn::app {
namespace {

using std::chrono::milliseconds;
using namespace test;

constexpr std::uint32_t kWidth = 64, kHeight = 48;

/// All of it has 32 °C.
Packet picture_at(int ms, std::uint32_t width = kWidth) {
  const std::uint16_t count = 30'515;
  std::vector<std::byte> payload(std::size_t{width} * kHeight * 2);
  for (std::size_t i = 0; i < payload.size(); i += 2) std::memcpy(&payload[i], &count, 2);
  Packet packet = camera::test::packet_of(camera::test::header_of(camera::FrameFormat::kY16, width, kHeight, 2 * width),
                                          payload, static_cast<std::uint64_t>(ms));
  packet.arrival = Time{milliseconds(ms)};
  return packet;
}

class ThermalStreamTest : public StreamsRig {
 protected:
  void fit_camera() {
    thermal::Config config;
    config.model = "plain";
    config.units = "centikelvin";
    const auto lens = cameras::CameraModel::create(
        {.width = kWidth, .height = kHeight, .fx = 40, .fy = 40, .cx = 31.5, .cy = 23.5, .distortion = {}});
    task_.show(std::make_unique<ThermalStream>(thermal::Thermal::create(config).value(),
                                               labelling::ThermalLifter(*lens, SE3(), {}), monitor_),
               {});
  }
  void scan_at(int ms, bool lost = false) {
    LocatedScan* scan = outlets_.scans.back();
    ASSERT_NE(scan, nullptr);
    *scan = {};
    scan->stamp = Time{milliseconds(ms)};
    scan->epoch = 4;
    scan->lost = lost;
    scan->points_base = {{5, 0, 0}, {-5, 0, 0}};
    outlets_.scans.push();
  }
  void show(Packet picture) {
    Packet* place = outlets_.thermal.pictures.back();
    ASSERT_NE(place, nullptr);
    *place = std::move(picture);
    outlets_.thermal.pictures.push();
  }
};

TEST_F(ThermalStreamTest, APictureAndTheScansAroundItMakeACloud) {
  fit_camera();
  RobotStream stream = connect(wanted({Stream::kThermal}));
  run();
  EXPECT_TRUE(outlets_.scans_wanted);
  EXPECT_TRUE(outlets_.thermal.wanted);
  scan_at(1000);
  show(picture_at(1040));
  run();
  EXPECT_TRUE(read<client::ThermalMessage>(stream).empty()) << "the scan after it is still to come";
  scan_at(1100);
  run();
  const auto clouds = read<client::ThermalMessage>(stream);
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_EQ(clouds[0].stamp, Time{milliseconds(1040)});
  EXPECT_EQ(clouds[0].epoch, 4U);
  EXPECT_TRUE(clouds[0].celsius);
  ASSERT_EQ(clouds[0].points.size(), 1U) << "the other point is behind the camera";
  EXPECT_EQ(clouds[0].points[0].point_base, Eigen::Vector3f(5, 0, 0));
  EXPECT_NEAR(clouds[0].points[0].value, 32, 1e-3);
  EXPECT_TRUE(read<client::ScanMessage>(stream).empty());
}

TEST_F(ThermalStreamTest, NothingIsTakenWhileNobodyWantsIt) {
  fit_camera();
  {
    RobotStream stream = connect(wanted({Stream::kThermal}));
    run();
  }
  run();
  EXPECT_FALSE(outlets_.scans_wanted);
  EXPECT_FALSE(outlets_.thermal.wanted);
  show(picture_at(1040));
  run();
  EXPECT_EQ(outlets_.thermal.pictures.size(), 0U) << "what was on its way is let go";
}

TEST_F(ThermalStreamTest, TheRateOfScansHoldsForCloudsToo) {
  fit_camera();
  auto wants = wanted({Stream::kThermal});
  wants.scan_hz = 5;
  RobotStream stream = connect(wants);
  run();
  std::size_t got = 0;
  for (int i = 0; i < 10; ++i) {
    scan_at(1000 + 100 * i);
    show(picture_at(1050 + 100 * i));
    run();
    got += read<client::ThermalMessage>(stream).size();
  }
  EXPECT_EQ(got, 5U);
}

TEST_F(ThermalStreamTest, AScanThatIsLostPlacesNoPicture) {
  fit_camera();
  RobotStream stream = connect(wanted({Stream::kThermal}));
  run();
  scan_at(1000);
  show(picture_at(1040));
  scan_at(1100, true);
  run();
  EXPECT_TRUE(read<client::ThermalMessage>(stream).empty());
}

TEST_F(ThermalStreamTest, APictureOfAnotherSizeIsAnEvent) {
  fit_camera();
  RobotStream stream = connect(wanted({Stream::kThermal}));
  run();
  scan_at(1000);
  show(picture_at(1040, 32));
  scan_at(1100);
  run();
  EXPECT_TRUE(read<client::ThermalMessage>(stream).empty());
  ASSERT_FALSE(monitor_.events().empty());
  EXPECT_NE(monitor_.events().back().what.find("32x48, not 64x48"), std::string::npos);
}

TEST_F(ThermalStreamTest, WithoutACameraAWishForCloudsSaysWhy) {
  task_.show(nullptr, "thermal.intrinsics of the profile are not set");
  RobotStream stream = connect(wanted({Stream::kThermal}));
  run();
  EXPECT_FALSE(outlets_.scans_wanted);
  ASSERT_FALSE(monitor_.events().empty());
  EXPECT_NE(monitor_.events().back().what.find("thermal.intrinsics of the profile are not set"), std::string::npos);
}

}  // namespace
}  // namespace cairn::app
