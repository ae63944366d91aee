// SPDX-License-Identifier: Apache-2.0
// Pictures and wheels of a core, read by another vendor's DDS field by field.
#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "tests/tools/ros/process/foreign_rig.hpp"

namespace cairn::ros {
namespace {

class ForeignSensors : public ForeignRos {};

TEST_F(ForeignSensors, ReadsPicturesAndHowTheCameraSees) {
  start_core();
  start_ros({"--frame-prefix", "h1/"});
  ASSERT_TRUE(until([&] { return core->subscription.has_value(); }));
  EXPECT_FALSE(core->subscription->wants(clients::Stream::kPictures));
  const std::string camera = "rt/husky_1/front/";
  auto payload = first(camera + "image_raw/compressed", "sensor_msgs::msg::dds_::CompressedImage_", fast::sensor_qos());
  ASSERT_TRUE(payload);
  Fields fields(*payload);
  expect_stamp(fields);
  EXPECT_EQ(fields.text(), "h1/front_optical");
  EXPECT_EQ(fields.text(), "mono16; png compressed ");
  const auto image = cv::imdecode(fields.next<std::vector<std::uint8_t>>(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.total() * image.elemSize(), pixels().size());
  EXPECT_EQ(std::memcmp(image.data, pixels().data(), pixels().size()), 0);

  auto described = first(camera + "camera_info", "sensor_msgs::msg::dds_::CameraInfo_", fast::default_qos());
  ASSERT_TRUE(described);
  Fields info(*described);
  expect_stamp(info);
  EXPECT_EQ(info.text(), "h1/front_optical");
  EXPECT_EQ(info.next<std::uint32_t>(), 4U);
  EXPECT_EQ(info.next<std::uint32_t>(), 8U);
  EXPECT_EQ(info.text(), "plumb_bob");
  EXPECT_EQ(info.next<std::vector<double>>(), (std::vector{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(info.reals(9), (std::vector<double>{10, 0, 4, 0, 11, 2, 0, 0, 1}));
  EXPECT_EQ(info.reals(9), (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(info.reals(12), (std::vector<double>{10, 0, 4, 0, 0, 11, 2, 0, 0, 0, 1, 0}));
  for (int i = 0; i < 6; ++i) EXPECT_EQ(info.next<std::uint32_t>(), 0U) << "binning and region";
  EXPECT_FALSE(info.next<bool>());
}

TEST_F(ForeignSensors, ReadsHowTheWheelsTurn) {
  start_core();
  start_ros();
  auto payload = first("rt/husky_1/joint_states", "sensor_msgs::msg::dds_::JointState_", fast::default_qos());
  ASSERT_TRUE(payload);
  Fields fields(*payload);
  expect_stamp(fields);
  EXPECT_EQ(fields.text(), "");
  EXPECT_EQ(fields.next<std::vector<std::string>>(),
            (std::vector<std::string>{"left_wheel_joint", "right_wheel_joint"}));
  EXPECT_EQ(fields.next<std::vector<double>>(), (std::vector<double>{4, -2}));
  EXPECT_EQ(fields.next<std::vector<double>>(), (std::vector<double>{0.5, -1}));
  EXPECT_TRUE(fields.next<std::vector<double>>().empty());
}

}  // namespace
}  // namespace cairn::ros
