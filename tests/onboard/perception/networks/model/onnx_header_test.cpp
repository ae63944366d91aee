// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/onnx_header.hpp"

#include <gmock/gmock.h>

#include "tests/onboard/perception/networks/tiny_onnx.hpp"

namespace cairn::networks {
namespace {

using test::Proto;
using test::TinyOnnx;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<OnnxHeader> header_of(std::string_view text) { return parse_onnx_header(std::as_bytes(std::span(text))); }

TEST(OnnxHeader, SaysWhatGoesInAndOut) {
  const auto header = header_of(test::colours(6, 4, 12).text());
  ASSERT_TRUE(header) << to_string(header.error());
  EXPECT_EQ(header->opset, 12);
  EXPECT_EQ(header->producer, "tests");
  ASSERT_EQ(header->inputs.size(), 1U) << "weights are no inputs";
  EXPECT_EQ(header->inputs[0].name, "picture");
  EXPECT_THAT(header->inputs[0].shape, ElementsAre(1, 3, 4, 6));
  ASSERT_EQ(header->outputs.size(), 1U);
  EXPECT_THAT(header->outputs[0].shape, ElementsAre(1, 3, 4, 6));
}

TEST(OnnxHeader, OldFilesListTheirWeightsAmongTheInputs) {
  TinyOnnx model;
  model.weights("w", {1}, {1}).input("w", {1}).input("picture", {1, 3, 0, 0}).output("y", {});
  const auto header = header_of(model.text());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->inputs.at(0).name, "picture");
  EXPECT_EQ(shape_text(header->inputs[0].shape), "1x3x?x?");
}

/// Wherever it ends, that is seen.
TEST(OnnxHeader, AFileThatIsCutOffIsSeen) {
  const std::string whole = test::colours().text();
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const auto header = header_of(std::string_view(whole).substr(0, size));
    ASSERT_FALSE(header) << size;
    EXPECT_THAT(to_string(header.error()), testing::AnyOf(HasSubstr("ends before"), HasSubstr("no ONNX file"))) << size;
  }
}

TEST(OnnxHeader, WhatIsNoModelIsRefused) {
  for (const std::string& text : {std::string(), std::string("\0\0\0\0", 4), std::string("PK\3\4archive"),
                                  std::string("\x0F\x01"), Proto().number(1, 6).text()}) {
    const auto header = header_of(text);
    ASSERT_FALSE(header) << text;
    EXPECT_FALSE(header.error().detail.empty());
  }
  EXPECT_THAT(header_of(TinyOnnx().input("a", {1}).text()).error().detail, HasSubstr("no output"));
}

TEST(OnnxHeader, OnePictureGoesIn) {
  const auto header = header_of(TinyOnnx().input("a", {1}).input("b", {1}).output("y", {1}).text());
  ASSERT_FALSE(header);
  EXPECT_THAT(to_string(header.error()), HasSubstr("this model has 2"));
}

// OpenCV 4.6 reads beyond the end of such weights.
TEST(OnnxHeader, WeightsThatDoNotFillTheirShapeAreRefused) {
  TinyOnnx few = test::colours(), many = test::colours(), huge = test::colours();
  few.weights("short", {2, 2}, {1, 2, 3});
  many.weights("long", {2}, {1, 2, 3});
  huge.weights("huge", {1 << 30, 1 << 30, 1 << 30}, {1});
  for (const TinyOnnx& model : {few, many, huge}) {
    const auto header = header_of(model.text());
    ASSERT_FALSE(header);
    EXPECT_THAT(to_string(header.error()), HasSubstr("another size than they say"));
  }
  // As a constant of a node: attribute `value`, a tensor of two numbers that holds one.
  const Proto tensor = Proto().bytes(1, "\x02").number(2, 1).bytes(4, "1234");
  TinyOnnx constant = test::colours();
  constant.raw(1, Proto().bytes(4, "Constant").message(5, Proto().bytes(1, "value").message(5, tensor)));
  EXPECT_FALSE(header_of(constant.text()));
}

TEST(OnnxHeader, WeightsElsewhereAreRefusedWithTheRemedy) {
  TinyOnnx model = test::colours();
  model.raw(5, Proto().number(1, 100).number(2, 1).bytes(8, "big").number(14, 1));
  const auto header = header_of(model.text());
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().code, Errc::kUnsupported);
  EXPECT_THAT(header.error().detail, HasSubstr("as one file"));
}

}  // namespace
}  // namespace cairn::networks
