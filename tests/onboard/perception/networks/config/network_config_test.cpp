// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/config/network_config.hpp"

#include <gmock/gmock.h>

namespace cairn::networks {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<PerceptionConfig> parsed(std::string_view yaml) {
  PerceptionConfig c;
  config::Section section;
  declare(section, c);
  if (auto set = config::parse(yaml, "robot.yaml", section); !set) return set.error();
  if (auto sound = check(c); !sound) return sound.error();
  return c;
}

TEST(NetworkConfig, TheProfileSaysHowANetworkIsFed) {
  const auto c = parsed(R"(
segmentation: {model: a.onnx, input_width: 1024, input_height: 512, mean: [72.392, 82.909, 73.158],
               std: [45.319, 46.153, 44.915], divisor: 255, classes: cityscapes20, rate_hz: 2}
detection: {model: b.onnx, sha256: 0123456789abcdef0123456789ABCDEF0123456789abcdef0123456789abcdef}
)");
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_EQ(c->segmentation.input_width, 1024);
  EXPECT_THAT(c->segmentation.std, ElementsAre(45.319, 46.153, 44.915));
  EXPECT_EQ(c->detection.family, "yolox");
  EXPECT_EQ(c->detection.classes, "coco80");
  EXPECT_FALSE(c->thermal_detection.exists());
}

TEST(NetworkConfig, TheDefaultsAreSoundAndHaveNoNetwork) {
  const auto c = parsed("");
  ASSERT_TRUE(c);
  EXPECT_FALSE(c->segmentation.exists() || c->detection.exists() || c->thermal_detection.exists());
}

TEST(NetworkConfig, WhatBoundsCannotSayIsCheckedAndAllFaultsComeAtOnce) {
  const auto c = parsed(R"(
segmentation: {model: a.onnx, family: yolox, sha256: abc, input_width: 5, std: [1, 0, 1], divisor: 0, classes: cat}
detection: {model: b.onnx, family: logits, strides: "8,x"}
)");
  ASSERT_FALSE(c);
  EXPECT_EQ(c.error().code, Errc::kInvalidConfig);
  for (const char* key :
       {"segmentation.family", "segmentation.sha256", "segmentation.input_width", "segmentation.std",
        "segmentation.divisor", "segmentation.classes", "detection.family", "detection.fit", "detection.strides"})
    EXPECT_THAT(c.error().detail, HasSubstr(std::string("perception.") + key + ": "));
}

TEST(NetworkConfig, ANetworkThatDoesNotExistIsNotChecked) {
  EXPECT_TRUE(parsed("segmentation: {classes: cat}"));
  EXPECT_FALSE(parsed("segmentation: {model: a.onnx, classes: cat}"));
}

TEST(NetworkConfig, StridesAreAListOfNumbers) {
  EXPECT_THAT(parse_strides("8, 16,32").value(), ElementsAre(8, 16, 32));
  for (const char* text : {"", "0", "8,,16", "257", "1,2,3,4,5,6,7,8,9", "8.5"})
    EXPECT_FALSE(parse_strides(text)) << text;
}

}  // namespace
}  // namespace cairn::networks
