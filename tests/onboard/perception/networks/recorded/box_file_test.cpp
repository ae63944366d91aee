// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/box_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace cairn::networks {
namespace {

using ::testing::HasSubstr;

Detections detections_of(std::int64_t stamp_ns, std::vector<Detection> found) {
  return {SourceId{1}, Time{Duration{stamp_ns}}, 100, 80, std::move(found)};
}

Image view_of(std::int64_t stamp_ns, int width = 100, int height = 80) {
  Image picture;
  picture.resize(PixelFormat::kMono8, width, height);
  picture.stamp = Time{Duration{stamp_ns}};
  return picture;
}

TEST(BoxFile, ARecordedDetectorSaysWhatTheNetworkSaid) {
  const support::TemporaryFolder folder;
  const Detection one{1.5F, 2.25F, 30.1F, 40, kPersonClass, 0.87654F}, two{50, 0, 10, 20, 13, 1};
  {
    auto writer = BoxWriter::create(folder / kBoxFile);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write("camera", detections_of(10, {one, two})));
    ASSERT_TRUE(writer->write("thermal", detections_of(10, {two})));
    ASSERT_TRUE(writer->write("camera", detections_of(20, {})));
    ASSERT_TRUE(writer->close());
  }
  auto detector = RecordedDetector::open(folder / kBoxFile, "camera");
  ASSERT_TRUE(detector);
  EXPECT_FALSE((*detector)->damage());
  EXPECT_EQ((*detector)->pictures(), 2U);
  const auto first = (*detector)->detect(view_of(10));
  ASSERT_TRUE(first) << to_string(first.error());
  ASSERT_EQ((*first)->found.size(), 2U);
  EXPECT_EQ((*first)->found[0].x, one.x) << "the numbers keep their bits";
  EXPECT_EQ((*first)->found[0].score, one.score);
  EXPECT_FLOAT_EQ((*first)->found[0].width, one.width);
  EXPECT_EQ((*first)->found[1].class_id, 13);
  EXPECT_EQ((*first)->width, 100);
  const auto none = (*detector)->detect(view_of(20));
  ASSERT_TRUE(none);
  EXPECT_TRUE((*none)->found.empty());
  EXPECT_EQ((*detector)->detect(view_of(15)).error().code, Errc::kNotFound);
  EXPECT_EQ((*RecordedDetector::open(folder / kBoxFile, "thermal"))->pictures(), 1U);
}

TEST(BoxFile, BoxesAreClippedToThePicture) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / kBoxFile) << "5,camera,-10,-10,30,20,11,0.5\n5,camera,90,70,50,50,11,0.5\n"
                                   << "5,camera,200,0,5,5,11,0.5\n";
  auto detector = RecordedDetector::open(folder / kBoxFile, "camera");
  const auto found = (*detector)->detect(view_of(5));
  ASSERT_EQ((*found)->found.size(), 2U);
  EXPECT_EQ((*found)->found[0].width, 20);
  EXPECT_EQ((*found)->found[0].height, 10);
  EXPECT_EQ((*found)->found[1].width, 10);
}

struct Fault {
  const char* line;
  const char* cause;
};

TEST(BoxFile, WhatComesBeforeAFaultIsKeptAndTheFaultIsNamed) {
  for (const Fault& fault : {Fault{"x,camera", "stamp"},
                             {"6", "expected"},
                             {"6,camera,1", "expected"},
                             {"4,camera", "decrease"},
                             {"5,camera", "other lines"},
                             {"6,ca mera", "name"},
                             {"6,camera,a,1,1,1,11,1", "numbers"},
                             {"6,camera,1,1,1,1,19,1", "trainId"},
                             {"6,camera,1,1,1,1,11,1.5", "score"},
                             {"6,camera,nan,1,1,1,11,1", "near"},
                             {"6,camera,1,1,-1,1,11,1", "near"}}) {
    std::vector<RecordedBoxes> pictures;
    const std::string text = std::string(kBoxHeader) + "5,camera,1,1,1,1,11,0.5\r\n\n" + fault.line + "\n";
    const auto parsed = parse_boxes(text, "boxes.csv", pictures);
    ASSERT_FALSE(parsed) << fault.line;
    EXPECT_THAT(to_string(parsed.error()), HasSubstr("boxes.csv:4: offset"));
    EXPECT_THAT(parsed.error().detail, HasSubstr(fault.cause)) << fault.line;
    EXPECT_EQ(pictures.size(), 1U);
  }
}

TEST(BoxFile, DamageLeavesWhatComesBefore) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / kBoxFile) << "5,camera\n6,camera,1,2,";
  auto detector = RecordedDetector::open(folder / kBoxFile, "camera");
  ASSERT_TRUE(detector);
  ASSERT_TRUE((*detector)->damage());
  EXPECT_TRUE((*detector)->detect(view_of(5)));
}

TEST(BoxWriter, RefusesWhatCannotBeRead) {
  const support::TemporaryFolder folder;
  auto writer = BoxWriter::create(folder / kBoxFile);
  ASSERT_TRUE(writer->write("camera", detections_of(10, {})));
  EXPECT_FALSE(writer->write("camera", detections_of(9, {})));
  EXPECT_FALSE(writer->write("a,b", detections_of(11, {})));
  EXPECT_FALSE(writer->write("", detections_of(11, {})));
  EXPECT_FALSE(writer->write("camera", detections_of(11, {{0, 0, 1, 1, kNoClass, 1}})));
  EXPECT_FALSE(writer->write("camera", detections_of(11, {{0, 0, 1, 1, 11, 2}})));
  EXPECT_FALSE(writer->write("camera", detections_of(11, std::vector<Detection>(1001, {0, 0, 1, 1, 11, 1}))));
  ASSERT_TRUE(writer->close());
  EXPECT_EQ((*RecordedDetector::open(folder / kBoxFile, "camera"))->pictures(), 1U);
}

}  // namespace
}  // namespace cairn::networks
