// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/streams_task.hpp"

#include <algorithm>

#include "tests/onboard/app/streams/streams_rig.hpp"

namespace cairn::app {
namespace {

using test::milliseconds;
using test::RobotStream;
using test::Stream;
using test::wanted;

class StreamsTaskTest : public test::StreamsRig {};

TEST_F(StreamsTaskTest, AClientGetsWhatItAskedFor) {
  RobotStream poses = connect(wanted({Stream::kPose})), states = connect(wanted({Stream::kState}));
  run();
  locate(1);
  run();
  EXPECT_EQ(read<clients::HelloMessage>(poses).size(), 1U);
  locate(2);
  run();
  const auto got = read<clients::PoseMessage>(poses);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].stamp, Time{milliseconds(200)});
  EXPECT_EQ(read<clients::PoseMessage>(states).size(), 0U);
  EXPECT_EQ(poses.lost() + states.lost(), 0U);
}

TEST_F(StreamsTaskTest, PeopleAreToldToThoseWhoAsk) {
  RobotStream people = connect(wanted({Stream::kPeople})), states = connect(wanted({Stream::kState}));
  run();
  PeopleNews* news = outlets_.people.back();
  ASSERT_NE(news, nullptr);
  news->stamp = Time{milliseconds(300)};
  news->people.resize(1);
  news->people[0].id = 4;
  news->people[0].position = {1, 2};
  news->people[0].ground = 0.5F;
  outlets_.people.push();
  run();
  const auto got = read<clients::PeopleMessage>(people);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].stamp, Time{milliseconds(300)});
  ASSERT_EQ(got[0].people.size(), 1U);
  EXPECT_EQ(got[0].people[0].id, 4U);
  EXPECT_EQ(got[0].people[0].position_odom, Eigen::Vector3d(1, 2, 0.5));
  EXPECT_TRUE(read<clients::PeopleMessage>(states).empty());
}

TEST_F(StreamsTaskTest, PeopleOfPeersAreAStreamOfTheirOwn) {
  RobotStream team = connect(wanted({Stream::kTeamPeople})), own = connect(wanted({Stream::kPeople}));
  run();
  PeopleNews* news = outlets_.team_people.back();
  ASSERT_NE(news, nullptr);
  news->robot = 2;
  news->people.resize(3);
  outlets_.team_people.push();
  run();
  const auto got = read<clients::PeopleMessage>(team);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].robot, 2U);
  EXPECT_EQ(got[0].people.size(), 3U);
  EXPECT_TRUE(read<clients::PeopleMessage>(own).empty());
}

TEST_F(StreamsTaskTest, WheelsAreToldToThoseWhoAsk) {
  RobotStream wheels = connect(wanted({Stream::kWheels})), states = connect(wanted({Stream::kState}));
  EXPECT_FALSE(outlets_.wheels_wanted);
  run();
  EXPECT_TRUE(outlets_.wheels_wanted);
  task_.set_wheel_radius(0.2);
  WheelNews* news = outlets_.wheels.back();
  ASSERT_NE(news, nullptr);
  news->state.stamp = Time{milliseconds(300)};
  news->state.v = 0.5;
  news->wheels.count = 2;
  news->wheels.wheels[0] = {.left = true, .travel_m = 3, .speed_m_s = 0.4};
  news->wheels.wheels[1] = {.left = true, .rear = true, .travel_m = 4};
  outlets_.wheels.push();
  run();
  const auto got = read<clients::WheelsMessage>(wheels);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].v, 0.5);
  EXPECT_EQ(got[0].radius_m, 0.2);
  ASSERT_EQ(got[0].wheels.size(), 2U);
  EXPECT_EQ(got[0].wheels[0].place, clients::WheelPlace::kFrontLeft);
  EXPECT_EQ(got[0].wheels[1].travel_m, 4);
  EXPECT_TRUE(read<clients::WheelsMessage>(states).empty());
}

class PictureStreamTest : public test::StreamsRig {
 protected:
  PictureStreamTest() { task_.show({{.message = {.camera = 1, .name = "thermal"}, .latency = milliseconds(30)}}); }
  /// False: there was no room.
  bool take_picture(int number, std::size_t bytes) {
    Packet* picture = outlets_.pictures[1].pictures.back();
    if (picture == nullptr) return false;
    picture->arrival = Time{milliseconds(1000 + 100 * number)};
    picture->bytes.assign(bytes, static_cast<std::byte>(number));
    outlets_.pictures[1].pictures.push();
    return true;
  }
};

TEST_F(PictureStreamTest, GoesToThoseWhoAskAtTheirRate) {
  auto wants = wanted({Stream::kCameras});
  RobotStream pictures = connect(wants);
  run();
  EXPECT_FALSE(outlets_.pictures[1].wanted);
  const auto cameras = read<client::CameraMessage>(pictures);
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0].name, "thermal");
  wants.add(Stream::kPictures);
  wants.picture_hz = 5;
  pictures.subscribe(wants);
  run();
  EXPECT_TRUE(outlets_.pictures[1].wanted);
  std::vector<client::PictureMessage> got;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(take_picture(i, 100'000));
    run(1);
    for (auto& picture : read<client::PictureMessage>(pictures)) got.push_back(std::move(picture));
  }
  ASSERT_EQ(got.size(), 4U);
  EXPECT_EQ(got[0].bytes, std::vector<std::byte>(100'000, std::byte{0}));
  EXPECT_EQ(got[1].camera, 1);
  EXPECT_EQ(got[1].stamp, Time{milliseconds(1170)}) << "it was taken 30 ms before it came";
  EXPECT_EQ(pictures.lost(), 0U);
}

TEST_F(PictureStreamTest, WhoDoesNotReadLosesPicturesAndNoPoses) {
  auto wants = wanted({Stream::kPictures, Stream::kPose});
  RobotStream slow = connect(wants);
  run();
  for (int i = 0; i < 10; ++i) {
    (void)take_picture(i, 1'000'000);
    locate(i + 1);
    run();
  }
  std::size_t poses = 0;
  std::vector<client::PictureMessage> got;
  for (int i = 0; i < 20; ++i, run()) {
    for (;;) {
      auto next = slow.next(Duration{});
      ASSERT_TRUE(next);
      if (std::holds_alternative<std::monostate>(*next)) break;
      if (std::holds_alternative<clients::PoseMessage>(*next)) ++poses;
      if (auto* picture = std::get_if<client::PictureMessage>(&*next)) got.push_back(std::move(*picture));
    }
  }
  EXPECT_EQ(poses, 10U);
  ASSERT_GE(got.size(), 1U) << "the newest ones come when it reads";
  for (const auto& picture : got) EXPECT_EQ(picture.bytes.size(), 1'000'000U);
  EXPECT_EQ(got.back().bytes.back(), std::byte{9});
}

TEST_F(StreamsTaskTest, TheStateComesAtOnceWithEveryChangeAndOnceASecond) {
  RobotStream states = connect(wanted({Stream::kState}));
  run();
  EXPECT_GE(read<clients::StateMessage>(states).size(), 1U);
  StateNews news;
  news.decision.mode = safety::Mode::kNormal;
  outlets_.state.publish(news);
  run(1);
  const auto changed = read<clients::StateMessage>(states);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].mode, clients::RobotMode::kNormal);
  run(400);  // two seconds
  EXPECT_EQ(read<clients::StateMessage>(states).size(), 2U);
}

TEST_F(StreamsTaskTest, PredictionsComeAtTheirRateUntilTheScanIsTooOld) {
  auto wants = wanted({Stream::kPose});
  wants.pose_hz = 100;
  RobotStream poses = connect(wants);
  run(20);  // 100 ms
  locate(1);
  run(200);  // one second
  const auto got = read<clients::PoseMessage>(poses);
  const auto predicted = std::ranges::count_if(got, &clients::PoseMessage::predicted);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(got.size()) - predicted, 1);
  EXPECT_NEAR(static_cast<double>(predicted), 50, 1);
  EXPECT_LE(got.back().stamp, Time{milliseconds(600)});
}

TEST_F(StreamsTaskTest, ScansAreCopiedForThoseWhoWantThemOnly) {
  run();
  EXPECT_FALSE(outlets_.scans_wanted);
  auto wants = wanted({Stream::kScan});
  wants.scan_hz = 5;
  {
    RobotStream scans = connect(wants);
    run();
    EXPECT_TRUE(outlets_.scans_wanted);
    std::vector<client::ScanMessage> got;
    for (int i = 0; i < 8; ++i) {
      LocatedScan* scan = outlets_.scans.back();
      ASSERT_NE(scan, nullptr);
      scan->stamp = Time{milliseconds(1000 + 100 * i)};
      scan->points_base.assign(7000, Eigen::Vector3f(1, 2, 3));
      outlets_.scans.push();
      run(1);
      for (auto& message : read<client::ScanMessage>(scans)) got.push_back(std::move(message));
    }
    ASSERT_EQ(got.size(), 4U);
    EXPECT_EQ(got[0].points_base.size(), 7000U);
    EXPECT_EQ(scans.lost(), 0U);
  }
  run();
  EXPECT_FALSE(outlets_.scans_wanted);
}

TEST_F(StreamsTaskTest, AScanThatDoesNotFitTheSocketComesInPartsOverSeveralTicks) {
  RobotStream scans = connect(wanted({Stream::kScan}));
  run();
  LocatedScan* scan = outlets_.scans.back();
  ASSERT_NE(scan, nullptr);
  scan->points_base.assign(100'000, Eigen::Vector3f(1, 2, 3));
  outlets_.scans.push();
  std::vector<client::ScanMessage> got;
  for (int i = 0; i < 100 && got.empty(); ++i) {
    run(1);
    got = read<client::ScanMessage>(scans);
  }
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].points_base.size(), 100'000U);
  EXPECT_EQ(scans.lost(), 0U);
}

TEST_F(StreamsTaskTest, WhoReadsTooSlowlyLosesWholeScans) {
  RobotStream scans = connect(wanted({Stream::kScan}));
  run();
  for (int i = 0; i < 6; ++i) {
    if (LocatedScan* scan = outlets_.scans.back()) {
      scan->stamp = Time{milliseconds(1000 + i)};
      scan->points_base.assign(20'000, Eigen::Vector3f(1, 2, 3));
      outlets_.scans.push();
    }
    run(1);
  }
  std::vector<client::ScanMessage> got;
  for (int i = 0; i < 10; ++i) {
    for (auto& message : read<client::ScanMessage>(scans)) got.push_back(std::move(message));
    run(1);
  }
  EXPECT_GE(got.size(), 1U);
  EXPECT_LT(got.size(), 6U);
  for (const auto& scan : got) EXPECT_EQ(scan.points_base.size(), 20'000U);
  EXPECT_GT(scans.lost(), 0U);
}

TEST_F(StreamsTaskTest, EventsOfThePastAndOfThePresent) {
  monitor_.event({}, "odometry", "lost");
  run(40);
  RobotStream events = connect(wanted({Stream::kEvents}));
  run();
  EXPECT_EQ(read<clients::EventMessage>(events).size(), 1U);
  monitor_.event({}, "odometry", "lost");
  run(40);
  const auto got = read<clients::EventMessage>(events);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].count, 2U);
}

}  // namespace
}  // namespace cairn::app
