// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/box_recorder.hpp"

#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

Detections boxes_at(int ms, int count) {
  Detections boxes{.source = {}, .stamp = Time{std::chrono::milliseconds(ms)}, .width = 64, .height = 48, .found = {}};
  for (int i = 0; i < count; ++i)
    boxes.found.push_back({.x = 1, .y = 2, .width = 3, .height = 4, .class_id = kPersonClass, .score = 0.5F});
  return boxes;
}

class BoxRecorderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto created = BoxRecorder::create(folder_.path(), monitor_);
    ASSERT_TRUE(created) << to_string(created.error());
    recorder_ = std::move(*created);
    visible_ = recorder_->add("camera");
    thermal_ = recorder_->add("thermal");
  }
  [[nodiscard]] std::vector<networks::RecordedBoxes> written() const {
    std::vector<networks::RecordedBoxes> pictures;
    const auto bytes = read_file(folder_ / networks::kBoxFile, networks::kMaxBoxFileBytes);
    EXPECT_TRUE(bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    EXPECT_TRUE(networks::parse_boxes(text, "boxes.csv", pictures));
    return pictures;
  }

  support::TemporaryFolder folder_;
  Monitor monitor_;
  std::unique_ptr<BoxRecorder> recorder_;
  std::size_t visible_ = 0, thermal_ = 0;
};

TEST_F(BoxRecorderTest, LinesAreInTheOrderOfStampsWhicheverNetworkIsFaster) {
  recorder_->keep(thermal_, boxes_at(100, 1));
  recorder_->keep(thermal_, boxes_at(300, 0));
  recorder_->write_waiting({});
  recorder_->keep(visible_, boxes_at(50, 2));
  recorder_->keep(visible_, boxes_at(200, 0));
  recorder_->write_waiting({});
  recorder_->close({});
  const auto pictures = written();
  ASSERT_EQ(pictures.size(), 4U);
  EXPECT_EQ(pictures[0].camera, "camera");
  EXPECT_EQ(pictures[0].found.size(), 2U);
  EXPECT_EQ(pictures[1].camera, "thermal");
  EXPECT_EQ(pictures[3].stamp, Time{std::chrono::milliseconds(300)});
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(BoxRecorderTest, WhatIsOldEnoughIsWrittenAtOnce) {
  recorder_->keep(visible_, boxes_at(0, 1));
  recorder_->keep(visible_, boxes_at(2500, 1));
  recorder_->write_waiting({});
  recorder_->close({});
  EXPECT_EQ(written().size(), 2U);
}

TEST_F(BoxRecorderTest, ASlowDiskLosesBoxesAndSaysSo) {
  for (int i = 0; i < 100; ++i) recorder_->keep(visible_, boxes_at(i, 0));
  recorder_->write_waiting({});
  recorder_->write_waiting({});
  ASSERT_EQ(monitor_.events().size(), 1U);
  recorder_->close({});
  EXPECT_LT(written().size(), 100U);
}

}  // namespace
}  // namespace cairn::app
