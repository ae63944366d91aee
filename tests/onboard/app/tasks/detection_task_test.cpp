// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/detection_task.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/onboard/app/tasks/grey_pictures.hpp"

namespace cairn::app {
namespace {

/// Sees as many people as the picture's number says, and a car.
class Counter final : public Detector {
 public:
  Result<const Detections*> detect(const Image& picture) override {
    const int n = picture.view().at<std::uint8_t>(0, 0);
    if (n == unknown) return Error{Errc::kNotFound, "nothing is recorded of this picture"};
    boxes_.stamp = picture.stamp;
    boxes_.width = picture.width;
    boxes_.height = picture.height;
    boxes_.found.assign(static_cast<std::size_t>(n), Detection{.class_id = kPersonClass, .score = 0.5F});
    boxes_.found.push_back({.class_id = 13, .score = 0.5F});
    return &boxes_;
  }
  int unknown = -1;

 private:
  Detections boxes_;
};

struct BoxKeeper final : scheduler::Task {
  void tick(scheduler::Tick& tick) override {
    while (const ArrivedBoxes* arrived = boxes.take(tick)) {
      all.push_back(*arrived);
      taken_at.push_back(tick.release());
    }
  }
  scheduler::InputPort<ArrivedBoxes> boxes{*this, "boxes"};
  std::vector<ArrivedBoxes> all;
  std::vector<Time> taken_at;
};

class DetectionTaskTest : public ::testing::Test {
 protected:
  void run(std::vector<Packet> packets, safety::Shed shed = safety::Shed::kNothing) {
    auto counter = std::make_unique<Counter>();
    counter->unknown = unknown_;
    const PictureForm form{.width = grey::kEyeWidth, .height = grey::kEyeHeight, .side_by_side = true, .judged = false};
    DetectionTask detection(
        {.eye = people::Eye::kThermal,
         .source = "camera",
         .reader = std::make_unique<ColourReader>(camera::Camera::create({}).value(), form),
         .detector = std::move(counter),
         .period = std::chrono::milliseconds(200)},
        "detection", {}, [shed] { return shed; }, monitor_);
    detection.keep_boxes([this](const Detections& boxes) { kept_.push_back(boxes.stamp); });
    ReceiveTask receive(monitor_);
    Input input;
    input.entry.kind = recording::kCamera;
    input.source = std::make_unique<grey::Pictures>(std::move(packets));
    ASSERT_TRUE(receive.add(input, SourceId{0}, {}));
    const ScheduleProfile schedule;
    scheduler::TaskGraph graph;
    graph.add(schedule.receive, receive, scheduler::TaskRole::kInput);
    graph.add(schedule.mapping, keeper_);
    graph.add(schedule.detection, detection);
    graph.connect(receive.watched, detection.pictures, {.capacity = 8});
    graph.connect(detection.boxes, keeper_.boxes, {.capacity = 8, .lag = schedule.detection.deadline()});
    ASSERT_TRUE(scheduler::Executive(graph).run_replay({.start = Time{std::chrono::seconds(1)}}));
    figures_ = detection.figures();
  }

  int unknown_ = -1;
  Monitor monitor_;
  BoxKeeper keeper_;
  std::vector<Time> kept_;
  DetectionTask::Figures figures_;
};

TEST_F(DetectionTaskTest, LooksAtOnePictureInAPeriodAndCountsPeople) {
  run(grey::pictures(7));
  ASSERT_EQ(keeper_.all.size(), 3U) << "pictures 0, 3 and 6";
  EXPECT_EQ(keeper_.all[1].eye, people::Eye::kThermal);
  EXPECT_EQ(keeper_.all[1].boxes.found.size(), 4U);
  EXPECT_EQ(figures_.images, 3U);
  EXPECT_EQ(figures_.people, 9U) << "cars are none";
  EXPECT_EQ(figures_.passed, 4U);
  EXPECT_EQ(kept_.size(), 3U);
}

TEST_F(DetectionTaskTest, BoxesAreThereWhenTheDeadlineHasPassed) {
  run(grey::pictures(12));
  ASSERT_GE(keeper_.all.size(), 1U);
  EXPECT_GE(keeper_.taken_at[0] - Time{std::chrono::seconds(1)}, ScheduleProfile().detection.deadline());
}

TEST_F(DetectionTaskTest, APictureWithoutRecordedBoxesIsCountedAndNoEvent) {
  unknown_ = 3;
  run(grey::pictures(7));
  EXPECT_EQ(keeper_.all.size(), 2U);
  EXPECT_EQ(figures_.unknown, 1U);
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(DetectionTaskTest, ADamagedPictureIsAnEventAndTheNextOneIsLookedAt) {
  auto packets = grey::pictures(7);
  packets[3].bytes.resize(packets[3].bytes.size() - 1);
  run(std::move(packets));
  EXPECT_EQ(keeper_.all.size(), 2U);
  EXPECT_EQ(figures_.refused, 1U);
  EXPECT_EQ(monitor_.events().size(), 1U);
}

/// In virtual time there is no overload; a live run's log says what was shed.
TEST_F(DetectionTaskTest, VirtualTimeKnowsNoOverload) {
  run(grey::pictures(7), safety::Shed::kSemantics);
  EXPECT_EQ(figures_.shed, 0U);
}

}  // namespace
}  // namespace cairn::app
