// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/view_guide.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "drivers/camera/camera.hpp"
#include "tests/onboard/app/tasks/grey_pictures.hpp"
#include "tests/onboard/perception/calibration/boards.hpp"
#include "tests/tools/cli/calibrate/board_recording.hpp"

namespace cairn::cli {
namespace {

namespace board_test = calibration::test;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const cameras::CameraModel& camera() {
  static const cameras::CameraModel model = *cameras::CameraModel::create(board_test::small_camera());
  return model;
}

Image seen(const Eigen::Vector3d& middle, const Eigen::Vector3d& turn) {
  static const board_test::BoardPainter painter(camera(), 2);
  std::mt19937 random(1);
  return painter.paint(board_test::kBoard, board_test::board_at(board_test::kBoard, middle, turn), 2, random);
}

TEST(ViewGuide, NamesWhatIsMissingUntilItWasShown) {
  ViewGuide guide(board_test::kBoard, false);
  EXPECT_TRUE(guide.look(seen({0, 0, 0.35}, {0, 0, 0}).view()));
  EXPECT_EQ(guide.views(), 1U);
  EXPECT_THAT(guide.missing(), Contains(HasSubstr("upper left")));
  EXPECT_THAT(guide.missing(), Contains(HasSubstr("its top towards the camera")));
  EXPECT_THAT(guide.text(), HasSubstr("1 views of the board; "));
  std::mt19937 random(7);
  const board_test::Holding how{.nearest = 7, .farthest = 14};
  static const board_test::BoardPainter painter(camera(), 2);
  for (int boards = 0; boards < 28;) {
    const SE3 T = board_test::random_pose(camera(), board_test::kBoard, how, random);
    if (!board_test::seen_corners(camera(), board_test::kBoard, T, 0, random)) continue;
    ++boards;
    (void)guide.look(painter.paint(board_test::kBoard, T, 2, random).view());
  }
  EXPECT_GT(guide.views(), 15U);
  EXPECT_THAT(guide.missing(), Not(Contains(HasSubstr("towards the camera")))) << guide.text();
}

TEST(ViewGuide, TheSameViewCountsOnce) {
  ViewGuide guide(board_test::kBoard, false);
  const Image picture = seen({0, 0, 0.35}, {0.3, 0, 0});
  EXPECT_TRUE(guide.look(picture.view()));
  EXPECT_FALSE(guide.look(picture.view()));
  EXPECT_EQ(guide.views(), 1U);
}

TEST(ViewGuide, APictureWithoutABoardIsNoView) {
  ViewGuide guide(board_test::kBoard, false);
  Image grey;
  grey.resize(PixelFormat::kMono8, 336, 240);
  EXPECT_FALSE(guide.look(grey.view()));
  EXPECT_EQ(guide.views(), 0U);
}

TEST(GuidedSource, HandsOnEverythingAndLooksTwiceASecond) {
  const Image first = seen({0, 0, 0.35}, {0.4, 0, 0}), second = seen({0, 0, 0.35}, {-0.4, 0, 0}),
              early = seen({0, 0, 0.35}, {0, 0.4, 0});
  const auto at_ms = [](int ms) { return Time(std::chrono::milliseconds(ms)); };
  app::grey::Pictures source({test::grey_packet(0, 0, at_ms(1000), first), test::grey_packet(1, 0, at_ms(1010), early),
                              test::grey_packet(0, 1, at_ms(1200), early),
                              test::grey_packet(0, 2, at_ms(1600), second)});
  ViewGuide guide(board_test::kBoard, false);
  auto eye = std::make_shared<camera::Camera>(camera::Camera::create({}).value());
  std::vector<std::size_t> told;
  GuidedSource guided(
      source, SourceId{0}, [eye](const Packet& p) { return eye->decode(p); }, false, guide,
      [&] { told.push_back(guide.views()); });
  std::size_t packets = 0;
  for (Packet packet; *guided.next(packet, {}) == Poll::kPacket;) ++packets;
  EXPECT_EQ(packets, 4U);
  EXPECT_THAT(told, ::testing::ElementsAre(1U, 2U))
      << "the picture of 1.2 s came too early, that of source 1 is no eye";
}

}  // namespace
}  // namespace cairn::cli
