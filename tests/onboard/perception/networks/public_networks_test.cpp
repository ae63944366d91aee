// SPDX-License-Identifier: Apache-2.0
// The two public networks on pictures of KITTI. Neither is part of the project.
#include <gmock/gmock.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "onboard/perception/networks/open_networks.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::networks {
namespace {

namespace fs = std::filesystem;

Image kitti_picture(const fs::path& file) {
  const cv::Mat pixels = cv::imread(file.string());
  Image image;
  image.resize(PixelFormat::kBgr8, pixels.cols, pixels.rows);
  std::copy_n(reinterpret_cast<const std::byte*>(pixels.ptr()), image.bytes.size(), image.bytes.begin());
  return image;
}

class PublicNetworks : public testing::Test {
 protected:
  void SetUp() override {
    for (const fs::path& needed : {networks_, pictures_})
      if (!fs::exists(needed)) GTEST_SKIP() << "the recorded data is not here: " << needed.string();
  }
  fs::path networks_ = support::recorded_data("onnx");
  fs::path pictures_ = support::recorded_data("kitti/raw_2011_09_26/image_02/data");
};

using FullPublicNetworks = PublicNetworks;

NetworkConfig espnet(const fs::path& folder) {
  NetworkConfig config;
  config.model = folder / "espnet_p2_q8_cityscapes_512x1024.onnx";
  config.mean = {72.392, 82.909, 73.158};
  config.std = {45.319, 46.153, 44.915};
  config.divisor = 255;
  config.classes = "cityscapes20";
  return config;
}

NetworkConfig yolox(const fs::path& folder) {
  NetworkConfig config = PerceptionConfig().detection;
  config.model = folder / "yolox_nano.onnx";
  return config;
}

TEST_F(FullPublicNetworks, EspnetLabelsAStreet) {
  auto segmenter = open_segmenter(espnet(networks_));
  ASSERT_TRUE(segmenter) << to_string(segmenter.error());
  const Image picture = kitti_picture(pictures_ / "0000000002.png");
  const LabelImage first = **(*segmenter)->segment(picture);
  EXPECT_EQ(first.width, 1024);
  EXPECT_EQ(first.height, 512);
  const LabelImage& second = **(*segmenter)->segment(picture);
  EXPECT_EQ(first.classes, second.classes);
  EXPECT_EQ(first.probabilities, second.probabilities);
  const auto road = std::count(first.classes.begin(), first.classes.end(), 0);
  EXPECT_GT(road, 1024 * 512 / 20);
}

TEST_F(PublicNetworks, YoloxFindsTheCars) {
  auto detector = open_detector(yolox(networks_));
  ASSERT_TRUE(detector) << to_string(detector.error());
  const Detections& found = **(*detector)->detect(kitti_picture(pictures_ / "0000000002.png"));
  const auto cars = std::count_if(found.found.begin(), found.found.end(),
                                  [](const Detection& d) { return kSemanticClasses[d.class_id].name == "car"; });
  EXPECT_GE(cars, 1);
}

}  // namespace
}  // namespace cairn::networks
