// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/perception_task.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/onboard/app/tasks/grey_pictures.hpp"

namespace cairn::app {
namespace {

using grey::kEyeHeight;
using grey::kEyeWidth;
using grey::kFrame;
using grey::picture;
using grey::Pictures;
using grey::pictures;

/// Says of every pixel that it is of the class that its value names.
class Parrot final : public Segmenter {
 public:
  Result<const LabelImage*> segment(const Image& picture) override {
    if (silent_from >= 0 && picture.view().at<std::uint8_t>(0, 0) >= silent_from)
      return Error{Errc::kNotFound, "nothing is recorded of this picture"};
    labels_.stamp = picture.stamp;
    labels_.resize(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        labels_.classes[labels_.index(x, y)] = picture.view().at<std::uint8_t>(x, y);
    return &labels_;
  }
  int silent_from = -1;

 private:
  LabelImage labels_;
};

struct Keeper final : scheduler::Task {
  void tick(scheduler::Tick& tick) override {
    while (const ArrivedLabels* arrived = labels.take(tick)) {
      all.push_back(arrived->labels);
      taken_at.push_back(tick.release());
    }
  }
  scheduler::InputPort<ArrivedLabels> labels{*this, "labels"};
  std::vector<LabelImage> all;
  std::vector<Time> taken_at;
};

/// Receive, perception, and one that keeps the labels, in virtual time.
class PerceptionTaskTest : public ::testing::Test {
 protected:
  void run(std::vector<Packet> packets, Duration period = std::chrono::milliseconds(200)) {
    camera::Config config;
    auto parrot = std::make_unique<Parrot>();
    parrot->silent_from = silent_from_;
    const PictureForm form{.width = kEyeWidth, .height = kEyeHeight, .side_by_side = true, .judged = judged_};
    PerceptionTask perception(
        {.reader = std::make_unique<ColourReader>(camera::Camera::create(config).value(), form),
         .segmenter = std::move(parrot),
         .period = period},
        {}, [] { return safety::Shed::kNothing; }, monitor_);
    perception.keep_labels([this](const LabelImage& labels) { kept_.push_back(labels.stamp); });
    ReceiveTask receive(monitor_);
    Input input;
    input.entry.kind = recording::kCamera;
    input.source = std::make_unique<Pictures>(std::move(packets));
    ASSERT_TRUE(receive.add(input, SourceId{0}, {}));
    const ScheduleProfile schedule;
    scheduler::TaskGraph graph;
    graph.add(schedule.receive, receive, scheduler::TaskRole::kInput);
    graph.add(schedule.mapping, keeper_);
    graph.add(schedule.perception, perception);
    graph.connect(receive.pictures, perception.pictures, {.capacity = 8});
    graph.connect(perception.labels, keeper_.labels, {.capacity = 8, .lag = schedule.perception.deadline()});
    ASSERT_TRUE(scheduler::Executive(graph).run_replay({.start = Time{std::chrono::seconds(1)}}));
    figures_ = perception.figures();
  }
  [[nodiscard]] bool reported(const std::string& what) const {
    return std::ranges::any_of(monitor_.events(),
                               [&](const Event& e) { return e.what.find(what) != std::string::npos; });
  }

  int silent_from_ = -1;
  bool judged_ = false;
  Monitor monitor_;
  Keeper keeper_;
  std::vector<Time> kept_;
  PerceptionTask::Figures figures_;
};

TEST_F(PerceptionTaskTest, KeepsItsRateAndLooksAtTheLeftEye) {
  run(pictures(46));
  EXPECT_EQ(keeper_.all.size(), 16U) << "three seconds at 5 Hz";
  for (std::size_t i = 1; i < keeper_.all.size(); ++i)
    EXPECT_EQ(keeper_.all[i].stamp - keeper_.all[i - 1].stamp, 3 * kFrame);
  for (const LabelImage& labels : keeper_.all) {
    EXPECT_EQ(labels.width, kEyeWidth);
    EXPECT_TRUE(std::ranges::all_of(labels.classes, [&](auto c) { return c == labels.classes[0] && c < 46; }));
  }
  EXPECT_EQ(figures_.images + figures_.passed, 46U);
  EXPECT_EQ(kept_.size(), 16U);
}

TEST_F(PerceptionTaskTest, LabelsAreThereWhenTheDeadlineHasPassed) {
  run(pictures(46));
  const std::size_t drained = 3;  // at the end nobody waits
  for (std::size_t i = 0; i + drained < keeper_.all.size(); ++i)
    EXPECT_GE(keeper_.taken_at[i] - keeper_.all[i].stamp, ScheduleProfile().perception.deadline());
}

TEST_F(PerceptionTaskTest, OfPicturesThatCameTogetherTheNewestIsLookedAt) {
  auto packets = pictures(4);
  for (Packet& packet : packets) packet.arrival = Time{std::chrono::seconds(1)} + kFrame;
  for (int i = 0; i < 4; ++i) packets[static_cast<std::size_t>(i)].arrival += Duration{i};
  run(std::move(packets), std::chrono::milliseconds(1));
  ASSERT_EQ(keeper_.all.size(), 1U);
  EXPECT_EQ(keeper_.all[0].classes[0], 3);
  EXPECT_EQ(figures_.passed, 3U);
}

TEST_F(PerceptionTaskTest, ADamagedPictureIsAnEventAndTheNextOneIsLookedAt) {
  auto packets = pictures(7);
  packets[0].bytes.resize(30);
  packets[3] = picture(3, 2 * kEyeWidth + 2);
  run(std::move(packets));
  EXPECT_EQ(keeper_.all.size(), 1U);
  EXPECT_EQ(figures_.refused, 2U);
  EXPECT_TRUE(reported("fewer bytes"));
  EXPECT_TRUE(reported("another size")) << "9x4, not 8x4";
}

TEST_F(PerceptionTaskTest, APictureWithoutRecordedLabelsIsCountedAndNoEvent) {
  silent_from_ = 3;
  run(pictures(7));
  EXPECT_EQ(keeper_.all.size(), 1U);
  EXPECT_EQ(figures_.unlabelled, 2U);
  EXPECT_TRUE(monitor_.events().empty());
}

/// A picture with contrast; what differs from the others is its first pixel.
Packet with_contrast(int n, std::uint8_t first) {
  Packet packet = picture(n);
  const auto pixels = std::span(packet.bytes).subspan(camera::kFrameHeaderBytes);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::byte>(i % 8 < 4 ? 200 : 60);
  pixels[0] = static_cast<std::byte>(first);
  return packet;
}

TEST_F(PerceptionTaskTest, NothingIsLabelledThatCannotBeSeen) {
  judged_ = true;
  auto packets = pictures(7);
  packets[6] = with_contrast(6, 13);
  run(std::move(packets));
  ASSERT_EQ(keeper_.all.size(), 1U);
  EXPECT_EQ(keeper_.all[0].classes[0], 13);
  EXPECT_EQ(figures_.refused, 2U);
  EXPECT_TRUE(reported("too dark"));
}

TEST_F(PerceptionTaskTest, AnOverexposedPictureIsAnEventAndTheNextOneIsLookedAt) {
  judged_ = true;
  auto packets = pictures(4);
  std::ranges::fill(std::span(packets[0].bytes).subspan(camera::kFrameHeaderBytes), std::byte{255});
  packets[3] = with_contrast(3, 13);
  run(std::move(packets));
  EXPECT_EQ(keeper_.all.size(), 1U);
  EXPECT_EQ(figures_.refused, 1U);
  EXPECT_TRUE(reported("overexposed"));
}

TEST_F(PerceptionTaskTest, ACameraThatIsStuckIsAnEvent) {
  judged_ = true;
  std::vector<Packet> packets;
  for (int n = 0; n < 19; ++n) packets.push_back(with_contrast(n, n < 10 ? 13 : static_cast<std::uint8_t>(n)));
  run(std::move(packets));
  EXPECT_TRUE(reported("stuck"));
  EXPECT_EQ(figures_.refused, 3U) << "all but the first";
  EXPECT_EQ(keeper_.all.size(), 4U);
}

TEST_F(PerceptionTaskTest, TimeThatWentBackDoesNotBlindIt) {
  auto packets = pictures(6);
  for (std::size_t i = 0; i < 3; ++i) packets[i].arrival += std::chrono::hours(1);
  std::rotate(packets.begin(), packets.begin() + 3, packets.end());
  run(std::move(packets));
  EXPECT_GE(keeper_.all.size(), 1U);
}

}  // namespace
}  // namespace cairn::app
