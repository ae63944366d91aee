// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/open_networks.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "tests/onboard/perception/networks/tiny_onnx.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::networks {
namespace {

using test::TinyOnnx;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Colour = std::array<unsigned char, 3>;
constexpr Colour kBlue{255, 0, 0}, kGreen{0, 255, 0}, kRed{0, 0, 255};

/// A picture of vertical stripes.
Image stripes(int width, int height, const std::vector<Colour>& colours) {
  Image image;
  image.resize(PixelFormat::kBgr8, width, height);
  image.source = SourceId{3};
  image.stamp = Time{Duration{77}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Colour& c = colours[static_cast<std::size_t>(x) * colours.size() / static_cast<std::size_t>(width)];
      for (std::size_t i = 0; i < 3; ++i)
        image.bytes[static_cast<std::size_t>(y) * image.stride + static_cast<std::size_t>(x) * 3 + i] =
            static_cast<std::byte>(c[i]);
    }
  return image;
}

class OpenNetworks : public testing::Test {
 protected:
  NetworkConfig config_of(const TinyOnnx& model, const char* family, const char* classes) {
    model.save(folder_ / "m.onnx");
    NetworkConfig config;
    config.model = folder_ / "m.onnx";
    config.family = family;
    config.classes = classes;
    return config;
  }
  support::TemporaryFolder folder_;
};

using OpenSegmenter = OpenNetworks;
using OpenDetector = OpenNetworks;

TEST_F(OpenSegmenter, EachPixelGetsItsClass) {
  NetworkConfig config = config_of(test::colours(), "logits", "road, person, none");
  config.divisor = 255;
  NetworkFacts facts;
  auto segmenter = open_segmenter(config, {}, &facts);
  ASSERT_TRUE(segmenter) << to_string(segmenter.error());
  EXPECT_EQ(facts.output, "1x3x4x6");
  EXPECT_EQ(facts.input_width, 6);
  const Image picture = stripes(12, 8, {kBlue, kGreen, kRed});
  const auto labels = (*segmenter)->segment(picture);
  ASSERT_TRUE(labels) << to_string(labels.error());
  const LabelImage& l = **labels;
  EXPECT_EQ(l.width, 6);
  EXPECT_EQ(l.height, 4);
  EXPECT_EQ(l.stamp, picture.stamp);
  EXPECT_EQ(l.source, picture.source);
  EXPECT_EQ(l.classes[l.index(0, 0)], 0);
  EXPECT_EQ(l.classes[l.index(2, 1)], kPersonClass);
  EXPECT_EQ(l.classes[l.index(5, 3)], kNoClass);
  // e^1 / (e^1 + 2)
  EXPECT_EQ(l.probabilities[l.index(0, 0)], std::lround(255 * std::exp(1.0) / (std::exp(1.0) + 2)));
}

TEST_F(OpenSegmenter, ChannelsMeanStdAndDivisorAreTheProfiles) {
  NetworkConfig config = config_of(test::colours(), "logits", "identity");
  config.channels = "rgb";
  config.mean = {55, 0, 0};
  config.std = {2, 1, 1};
  config.divisor = 50;  // red: (255 - 55) / 2 / 50 = 2; the other planes: 0
  auto segmenter = open_segmenter(config);
  ASSERT_TRUE(segmenter);
  const Image picture = stripes(6, 4, {kRed});
  const LabelImage& l = **(*segmenter)->segment(picture);
  EXPECT_EQ(l.classes[0], 0) << "red is the first plane";
  EXPECT_EQ(l.probabilities[0], std::lround(255 * std::exp(2.0) / (std::exp(2.0) + 2)));
}

TEST_F(OpenSegmenter, GreyPicturesAndGreyNetworksGoTogether) {
  NetworkConfig config =
      config_of(test::convolution(4, 4, {{1}, {0}}, {0, 100}).output("planes", {1, 2, 4, 4}), "logits", "identity");
  config.channels = "grey";
  auto segmenter = open_segmenter(config);
  ASSERT_TRUE(segmenter) << to_string(segmenter.error());
  Image grey;
  grey.resize(PixelFormat::kMono8, 4, 4);
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{200});
  EXPECT_EQ((**(*segmenter)->segment(grey)).classes[0], 0);
  const Image dark = stripes(4, 4, {Colour{0, 0, 0}});
  EXPECT_EQ((**(*segmenter)->segment(dark)).classes[0], 1);
}

TEST_F(OpenSegmenter, APictureThatIsNoneIsAnErrorAndTheNextOneIsLabelled) {
  auto segmenter = open_segmenter(config_of(test::colours(), "logits", "identity"));
  Image deep;
  deep.resize(PixelFormat::kMono16, 4, 4);
  EXPECT_EQ((*segmenter)->segment(deep).error().code, Errc::kUnsupported);
  EXPECT_EQ((*segmenter)->segment(Image()).error().code, Errc::kUnsupported);
  EXPECT_TRUE((*segmenter)->segment(stripes(1, 1, {kRed})));
  EXPECT_TRUE((*segmenter)->segment(stripes(2000, 3, {kRed})));
}

TEST_F(OpenSegmenter, AnInputOfAnotherShapeIsRefusedWithBoth) {
  NetworkConfig config = config_of(test::colours(), "logits", "identity");
  config.channels = "grey";
  const auto grey = open_segmenter(config);
  ASSERT_FALSE(grey);
  EXPECT_EQ(grey.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(to_string(grey.error()), AllOf(HasSubstr("m.onnx"), HasSubstr("found 1x3x4x6"), HasSubstr("`channels`")));
  const auto open = open_segmenter(
      config_of(test::convolution(0, 0, {{1, 0, 0}}, {0}).output("planes", {1, 1, 0, 0}), "logits", "identity"));
  ASSERT_FALSE(open);
  EXPECT_THAT(to_string(open.error()), HasSubstr("set input_width and input_height"));
}

TEST_F(OpenSegmenter, AModelWithAnOpenSizeTakesTheProfiles) {
  NetworkConfig config =
      config_of(test::convolution(0, 0, {{1, 0, 0}}, {0}).output("planes", {1, 1, 0, 0}), "logits", "identity");
  config.input_width = 8;
  config.input_height = 5;
  auto segmenter = open_segmenter(config);
  ASSERT_TRUE(segmenter) << to_string(segmenter.error());
  EXPECT_EQ((**(*segmenter)->segment(stripes(20, 20, {kRed}))).height, 5);
}

TEST_F(OpenSegmenter, AnOutputThatDoesNotFitTheClassesIsRefusedWithBoth) {
  const auto segmenter = open_segmenter(config_of(test::colours(), "logits", "cityscapes19"));
  ASSERT_FALSE(segmenter);
  EXPECT_THAT(to_string(segmenter.error()),
              AllOf(HasSubstr("expected 1x19xheightxwidth, found 1x3x4x6"), HasSubstr("`classes`")));
  const auto flat = open_segmenter(config_of(test::table(6, 4, {1, 3}, {1, 2, 3}), "logits", "identity"));
  ASSERT_FALSE(flat);
  EXPECT_THAT(to_string(flat.error()), HasSubstr("found 1x3"));
}

TEST_F(OpenSegmenter, WhatOpenCvCannotRunNamesTheOpset) {
  TinyOnnx model(17);
  model.input("picture", {1, 3, 4, 6}).node("FancyLayer", {"picture"}, "planes").output("planes", {1, 3, 4, 6});
  const auto segmenter = open_segmenter(config_of(model, "logits", "identity"));
  ASSERT_FALSE(segmenter);
  EXPECT_EQ(segmenter.error().code, Errc::kUnsupported);
  EXPECT_THAT(to_string(segmenter.error()), AllOf(HasSubstr("opset 17"), HasSubstr("export it again")));
}

TEST_F(OpenSegmenter, ADamagedModelNeverThrows) {
  const std::string whole = test::colours().text();
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    const NetworkConfig config = config_of(test::colours(), "logits", "identity");
    std::ofstream(folder_ / "m.onnx", std::ios::binary) << damaged;
    const auto segmenter = open_segmenter(config);
    EXPECT_TRUE(segmenter.has_value() || !segmenter.error().cause.empty());
  }
}

TEST_F(OpenSegmenter, AModelWithoutASumIsNoted) {
  NetworkConfig config = config_of(test::colours(), "logits", "identity");
  NetworkFacts facts;
  ASSERT_TRUE(open_segmenter(config, {}, &facts));
  EXPECT_THAT(facts.note(), AllOf(HasSubstr("m.onnx"), HasSubstr(facts.sha256)));
  config.sha256 = facts.sha256;
  ASSERT_TRUE(open_segmenter(config, {}, &facts));
  EXPECT_EQ(facts.note(), "");
}

TEST_F(OpenSegmenter, ADetectorIsNoSegmenter) {
  EXPECT_FALSE(open_segmenter(config_of(test::colours(), "yolox", "identity")));
  EXPECT_FALSE(open_detector(config_of(test::colours(), "logits", "identity")));
}

/// One cell of 16 pixels, and a class.
TinyOnnx one_box() { return test::table(16, 16, {1, 1, 6}, {0.5F, 0.5F, 0, 0, 0.9F, 1}); }

TEST_F(OpenDetector, YoloxBoxesAreInPixelsOfThePicture) {
  NetworkConfig config = config_of(one_box(), "yolox", "person");
  config.strides = "16";
  config.fit = "letterbox";
  auto detector = open_detector(config);
  ASSERT_TRUE(detector) << to_string(detector.error());
  const auto found = (*detector)->detect(stripes(64, 32, {kRed}));
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)->width, 64);
  ASSERT_EQ((*found)->found.size(), 1U);
  const Detection& d = (*found)->found[0];
  EXPECT_EQ(d.class_id, kPersonClass);
  EXPECT_NEAR(d.score, 0.9F, 1e-5);
  EXPECT_FLOAT_EQ(d.width, 64) << "a pixel of the input is four of the picture";
  EXPECT_FLOAT_EQ(d.height, 32) << "the input's lower half is not of the picture";
}

TEST_F(OpenDetector, YoloxOfAnotherShapeIsRefusedWithBoth) {
  NetworkConfig config = config_of(one_box(), "yolox", "person");
  const auto rows = open_detector(config);
  ASSERT_FALSE(rows);
  EXPECT_THAT(to_string(rows.error()),
              AllOf(HasSubstr("expected 1x5x(5 + 1)"), HasSubstr("found 1x1x6"), HasSubstr("`strides`")));
  config.strides = "16";
  config.classes = "coco80";
  EXPECT_THAT(to_string(open_detector(config).error()), HasSubstr("`classes`"));
}

TEST_F(OpenDetector, SsdListsAreReadInBothForms) {
  const auto rows = test::table(16, 16, {1, 1, 2, 7}, {0, 1, 0.8F, 0, 0, 0.5F, 1, 0, 1, 0.1F, 0, 0, 1, 1});
  auto detector = open_detector(config_of(rows, "ssd", "none, person"));
  ASSERT_TRUE(detector) << to_string(detector.error());
  const auto found = (*detector)->detect(stripes(64, 32, {kRed}));
  ASSERT_TRUE(found);
  ASSERT_EQ((*found)->found.size(), 1U);
  EXPECT_FLOAT_EQ((*found)->found[0].width, 32);

  TinyOnnx pair = test::table(16, 16, {1, 2, 2}, {0.1F, 0.9F, 0.8F, 0.2F});
  pair.weights("b2", {8}, {0, 0, 0.5F, 1, 0, 0, 1, 1})
      .weights("w2", {8, 3, 1, 1}, std::vector<float>(24, 0))
      .integers("shape2", {1, 2, 4})
      .node("Conv", {"picture", "w2", "b2"}, "planes2", "kernel_shape", {1, 1})
      .node("GlobalAveragePool", {"planes2"}, "numbers2")
      .node("Reshape", {"numbers2", "shape2"}, "boxes")
      .output("boxes", {1, 2, 4});
  auto second = open_detector(config_of(pair, "ssd", "none, person"));
  ASSERT_TRUE(second) << to_string(second.error());
  const auto again = (*second)->detect(stripes(64, 32, {kRed}));
  ASSERT_TRUE(again);
  ASSERT_EQ((*again)->found.size(), 1U);
  EXPECT_FLOAT_EQ((*again)->found[0].width, 32);
  EXPECT_NEAR((*again)->found[0].score, 0.9F, 1e-5);
}

TEST_F(OpenDetector, SsdOfAnotherShapeIsRefusedWithBoth) {
  const auto detector = open_detector(config_of(one_box(), "ssd", "none, person"));
  ASSERT_FALSE(detector);
  EXPECT_THAT(to_string(detector.error()), AllOf(HasSubstr("1x1xNx7"), HasSubstr("found 1x1x6")));
}

}  // namespace
}  // namespace cairn::networks
