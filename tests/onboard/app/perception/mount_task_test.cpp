// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/mount_task.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/onboard/app/tasks/grey_pictures.hpp"
#include "tests/onboard/perception/mount/textured_room.hpp"

namespace cairn::app {
namespace {

constexpr Time kStart{std::chrono::seconds(1)};
constexpr Duration kScan = std::chrono::milliseconds(100), kPicture = std::chrono::milliseconds(200);

/// Tells where the robot was at the end of each scan, until `last`.
struct Odometer final : scheduler::Task {
  void tick(scheduler::Tick& tick) override {
    while (next + kScan / 2 <= tick.release() && next <= last) {
      ArrivedPose* pose = poses.back(tick);
      if (pose == nullptr) return;
      *pose = {.stamp = next, .T_odom_base = mount::test::driven(to_seconds(next - kStart))};
      poses.push(tick);
      next += kScan;
    }
  }
  scheduler::OutputPort<ArrivedPose> poses{*this, "poses"};
  Time next = kStart, last = Time::max();
};

/// Pictures of a room, which a robot takes that drives through it; ten a second.
std::vector<Packet> pictures(int count) {
  const mount::test::TexturedRoom room;
  std::vector<Packet> packets;
  for (int n = 0; n < count; ++n) {
    const Time stamp = kStart + n * kPicture / 2;
    const Image image = room.see(mount::test::small_camera(), mount::test::driven(to_seconds(stamp - kStart)), stamp);
    const auto width = static_cast<std::uint32_t>(image.width), height = static_cast<std::uint32_t>(image.height);
    packets.push_back(camera::test::packet_of(camera::test::header_of(camera::FrameFormat::kGrey, width, height, width),
                                              camera::test::Bytes(image.bytes.begin(), image.bytes.end()),
                                              static_cast<std::uint64_t>(n)));
    packets.back().arrival = stamp;
  }
  return packets;
}

/// Receive, a stand-in for odometry, and the task, in virtual time.
class MountTaskTest : public ::testing::Test {
 protected:
  void run(const Eigen::Vector3d& turn_deg, std::vector<Packet> packets, Time last_pose = Time::max()) {
    const cameras::CameraModel camera = mount::test::small_camera();
    const PictureForm form{.width = camera.width(), .height = camera.height(), .side_by_side = false};
    std::vector<MountParts> eyes;
    eyes.push_back({.eye = people::Eye::kVisible,
                    .source = "camera",
                    .reader = std::make_unique<ColourReader>(camera::Camera::create({}).value(), form),
                    .watch = mount::MountWatch(camera, mount::test::wrong_mount(turn_deg), {}),
                    .period = kPicture});
    task_ = std::make_unique<MountTask>(
        std::move(eyes), Duration{}, [] { return safety::Shed::kNothing; }, monitor_);
    ReceiveTask receive(monitor_);
    Input input;
    input.entry.kind = recording::kCamera;
    input.source = std::make_unique<grey::Pictures>(std::move(packets));
    ASSERT_TRUE(receive.add(input, SourceId{0}, {}));
    Odometer odometer;
    odometer.last = last_pose;
    const ScheduleProfile schedule;
    scheduler::TaskGraph graph;
    graph.add(schedule.receive, receive, scheduler::TaskRole::kInput);
    graph.add(schedule.odometry, odometer);
    graph.add(schedule.mount, *task_);
    graph.connect(receive.mounted, task_->pictures, {.capacity = 8});
    graph.connect(odometer.poses, task_->poses, {.capacity = 64});
    ASSERT_TRUE(scheduler::Executive(graph).run_replay({.start = kStart}));
  }
  [[nodiscard]] const MountTask::Watched& eye() const { return task_->watched().front(); }
  [[nodiscard]] std::size_t said(const std::string& what) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        monitor_.events(), [&](const Event& e) { return e.what.find(what) != std::string::npos; }));
  }

  Monitor monitor_;
  std::unique_ptr<MountTask> task_;
};

TEST_F(MountTaskTest, SaysOnceByHowMuchACameraIsTurned) {
  run({0, 1.5, 0}, pictures(180));
  EXPECT_TRUE(eye().parts.watch.moved());
  EXPECT_EQ(said("camera_moved: the colour camera is turned by roll"), 1U);
  EXPECT_EQ(said("pitch 1."), 1U);
  EXPECT_GT(eye().figures.images, 80U);
  EXPECT_GT(eye().figures.passed, 80U) << "five of ten a second are looked at";
}

TEST_F(MountTaskTest, SaysNothingOfACameraThatLooksWhereItShould) {
  run({0, 0, 0}, pictures(180));
  EXPECT_FALSE(eye().parts.watch.moved());
  EXPECT_TRUE(eye().parts.watch.estimate());
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(MountTaskTest, PicturesWithoutScansAreCounted) {
  run({0, 0, 0}, pictures(100), kStart + std::chrono::seconds(2));
  EXPECT_LE(eye().figures.images, 11U);
  EXPECT_GT(eye().figures.refused, 30U);
}

TEST_F(MountTaskTest, DamagedPicturesAreCounted) {
  auto packets = pictures(60);
  for (std::size_t i = 20; i < 40; ++i) packets[i].bytes.resize(50);
  run({0, 0, 0}, std::move(packets));
  EXPECT_GE(eye().figures.refused, 10U);
  EXPECT_GT(eye().figures.images, 15U);
}

}  // namespace
}  // namespace cairn::app
