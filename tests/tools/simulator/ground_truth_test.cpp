// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/ground_truth.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/thermal/thermal.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::simulator {
namespace {

/// Asks true_boxes.csv for every picture of `dir` and counts the people on them.
class TrueBoxes {
 public:
  explicit TrueBoxes(const std::filesystem::path& dir)
      : reader_(recording::RecordingReader::open(dir).value()),
        colour_(networks::RecordedDetector::open(dir / "true_boxes.csv", "camera").value()),
        thermal_(networks::RecordedDetector::open(dir / "true_boxes.csv", "thermal").value()) {}

  void check() {
    Packet packet;
    for (auto poll = reader_->next(packet, Duration::zero()); poll && *poll != Poll::kEnd;
         poll = reader_->next(packet, Duration::zero())) {
      if (*poll != Poll::kPacket) continue;
      if (reader_->recording().sources[static_cast<std::size_t>(packet.source)].id == "camera") {
        Image left;
        ASSERT_TRUE(camera::left_eye(*camera_.decode(packet).value(), left));
        ask(*colour_, left, of_camera);
      } else {
        ask(*thermal_, lepton_.decode(packet).value()->stretched, of_thermal);
      }
    }
  }

  struct Count {
    std::size_t pictures = 0, people = 0;
  };
  Count of_camera, of_thermal;

 private:
  static void ask(networks::RecordedDetector& truth, const Image& picture, Count& count) {
    ++count.pictures;
    const auto found = truth.detect(picture);
    ASSERT_TRUE(found) << to_string(found.error());
    count.people += (*found)->found.size();
    for (const Detection& d : (*found)->found) {
      EXPECT_EQ(d.class_id, kPersonClass);
      EXPECT_GE(d.score, 0.15F);
      EXPECT_LE(d.score, 1.0F);
      EXPECT_LE(d.x + d.width, static_cast<float>(picture.width));
      EXPECT_LE(d.y + d.height, static_cast<float>(picture.height));
    }
  }

  std::unique_ptr<recording::RecordingReader> reader_;
  std::unique_ptr<networks::RecordedDetector> colour_, thermal_;
  camera::Camera camera_ = camera::Camera::create({}).value();
  thermal::Thermal lepton_ = thermal::Thermal::create({}).value();
};

class GroundTruth : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, GroundTruth, testing::Values("corridor"),
                         [](const auto& i) { return std::string(i.param); });
INSTANTIATE_TEST_SUITE_P(FullScenes, GroundTruth, testing::Values("street"),
                         [](const auto& i) { return std::string(i.param); });

TEST_P(GroundTruth, EveryPicturesPeopleAreToldUnderTheStampThatTheDecodersGiveIt) {
  const support::TemporaryFolder folder;
  SimulationConfig c;
  c.scene = GetParam();
  c.seconds = 0.3;
  c.out = folder / "out";
  c.sensors = {false, true, true, false, false, false};
  c.stereo.lens = {84, 46, 44, 44, 42, 23};
  c.people.count = 12;
  const auto robots = simulate(c);
  ASSERT_TRUE(robots) << to_string(robots.error());
  TrueBoxes truth(c.out / "robot_1");
  truth.check();
  EXPECT_EQ(truth.of_camera.pictures, robots->front().camera_frames);
  EXPECT_EQ(truth.of_thermal.pictures, robots->front().thermal_frames);
  EXPECT_GT(truth.of_camera.people, 0U);
  EXPECT_GT(truth.of_thermal.people, 0U);
}

}  // namespace
}  // namespace cairn::simulator
