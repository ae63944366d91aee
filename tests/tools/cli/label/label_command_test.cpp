// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/label_command.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "drivers/camera/frame.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/files/file.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"
#include "tests/drivers/thermal/lepton.hpp"
#include "tests/onboard/perception/networks/tiny_onnx.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using camera::FrameFormat;
using ::testing::HasSubstr;

Outcome label_with(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "label");
  return run(add_label_command, std::move(arguments));
}

Packet packet_of(std::size_t source, int n, const camera::FrameHeader& header, const std::vector<std::byte>& pixels) {
  Packet p;
  p.source = static_cast<SourceId>(source);
  p.sequence = static_cast<std::uint64_t>(n);
  p.arrival = Time(std::chrono::milliseconds(100 * n));
  camera::append_header(p.bytes, header);
  p.bytes.insert(p.bytes.end(), pixels.begin(), pixels.end());
  return p;
}

/// 24×8 pixels: the left eye is red, the right one blue.
Packet stereo_packet(int n) {
  std::vector<std::byte> pixels;
  for (int i = 0; i < 24 * 8; ++i) {
    const bool left = i % 24 < 12;
    for (const int value : {left ? 0 : 255, 0, left ? 255 : 0}) pixels.push_back(static_cast<std::byte>(value));
  }
  return packet_of(0, n, {static_cast<std::uint32_t>(FrameFormat::kBgr), 24, 8, 72, false}, pixels);
}

/// 20×10 pixels, the right half warm.
Packet thermal_packet(int n) {
  std::vector<std::byte> pixels;
  for (int i = 0; i < 20 * 10; ++i) {
    const int counts = i % 20 < 10 ? 7000 : 9000;
    pixels.push_back(static_cast<std::byte>(counts & 0xFF));
    pixels.push_back(static_cast<std::byte>(counts >> 8));
  }
  return packet_of(1, n, {static_cast<std::uint32_t>(FrameFormat::kY16), 20, 10, 40, false}, pixels);
}

class LabelCommand : public testing::Test {
 protected:
  void SetUp() override {
    recording::Recording r;
    r.robot = "robot_1";
    r.sources = {{"camera", recording::kCamera, "camera/data.csv", "camera", ""},
                 {"thermal", recording::kThermal, "thermal/data.csv", "thermal", "plain"}};
    auto writer = recording::RecordingWriter::create(recording_, r).value();
    for (int n = 1; n <= 3; ++n) {
      ASSERT_TRUE(writer.write(stereo_packet(n)));
      ASSERT_TRUE(writer.write(thermal_packet(n)));
    }
    ASSERT_TRUE(writer.close());
    networks::test::colours().save(folder_ / "colours.onnx");
    // One cell of 16 pixels: the whole input, of the class that has to be named.
    networks::test::table(16, 16, {1, 1, 6}, {0.5F, 0.5F, 0, 0, 0.9F, 1}).save(folder_ / "box.onnx");
  }
  std::string profile(const std::string& perception) {
    const fs::path path = folder_ / "robot.yaml";
    std::ofstream(path) << "thermal: {model: plain, capture: {width: 20, height: 10}}\nperception:\n" << perception;
    return path;
  }
  std::string all_networks() {
    return profile(
        "  segmentation: {model: colours.onnx, classes: \"road, building, person\", divisor: 25}\n"
        "  detection: {model: box.onnx, classes: car, strides: \"16\"}\n"
        "  thermal_detection: {model: box.onnx, classes: person, strides: \"16\"}\n");
  }

  TemporaryFolder folder_;
  std::string recording_ = folder_ / "r";
};

TEST_F(LabelCommand, LeavesWhatARunCanUseInsteadOfTheNetworks) {
  const Outcome o =
      label_with({recording_, "--config", all_networks(), "--out", folder_ / "out", "--overlay", "--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  const auto json = o.json();
  EXPECT_EQ(json["pictures"], 6);
  EXPECT_EQ(json["segmentation"]["pictures"], 3);
  EXPECT_EQ(json["segmentation"]["share"]["person"], 1.0) << "the left eye alone: " << json;
  EXPECT_EQ(json["detection"]["boxes"]["car"], 3);
  EXPECT_EQ(json["thermal_detection"]["boxes"]["person"], 3);
  EXPECT_EQ(json["notes"].size(), 3U) << "three models without a sum";

  Image picture;
  picture.resize(PixelFormat::kBgr8, 12, 8);
  picture.stamp = Time(std::chrono::milliseconds(200));
  networks::RecordedSegmenter segmenter(folder_ / "out/labels");
  const auto labels = segmenter.segment(picture);
  ASSERT_TRUE(labels) << to_string(labels.error());
  EXPECT_TRUE(std::ranges::all_of((*labels)->classes, [](std::uint8_t id) { return id == kPersonClass; }));
  auto detector = networks::RecordedDetector::open(folder_ / "out/boxes.csv", "camera");
  ASSERT_TRUE(detector);
  EXPECT_EQ((*detector)->pictures(), 3U);
  const auto found = (*detector)->detect(picture);
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)->found.at(0).width, 12);
  for (const char* file : {"overlay/camera/300000000.png", "overlay/thermal/100000000.png"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
}

TEST_F(LabelCommand, BoxesOfAllCamerasAreInTheOrderOfTheirStamps) {
  ASSERT_EQ(label_with({recording_, "--config", all_networks(), "--out", folder_ / "out"}).exit_code, app::kDone);
  const auto bytes = read_file(folder_ / "out/boxes.csv", 10'000).value();
  std::vector<networks::RecordedBoxes> pictures;
  ASSERT_TRUE(networks::parse_boxes({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "boxes", pictures));
  std::vector<std::string> cameras;
  for (const auto& picture : pictures) cameras.push_back(picture.camera);
  EXPECT_THAT(cameras, testing::ElementsAre("camera", "thermal", "camera", "thermal", "camera", "thermal"));
  EXPECT_TRUE(std::ranges::is_sorted(pictures, {}, &networks::RecordedBoxes::stamp));
}

/// A flat-field correction runs at 0.1 s, and the picture settles for a second.
TEST_F(LabelCommand, ThermalPicturesOfAFlatFieldCorrectionAreLeftOut) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"thermal", recording::kThermal, "thermal/data.csv", "thermal", "lepton3"}};
  auto writer = recording::RecordingWriter::create(folder_ / "corrected", r).value();
  for (std::uint32_t n = 1; n <= 15; ++n) {
    thermal::test::Telemetry telemetry;
    telemetry.counter(n).put32(
        3, static_cast<std::uint32_t>(n == 1 ? thermal::FlatField::kRunning : thermal::FlatField::kNever) << 4U);
    Packet packet = thermal::test::lepton3(telemetry, 30000, n, Time(std::chrono::milliseconds(100 * n)));
    packet.source = SourceId{0};
    ASSERT_TRUE(writer.write(packet));
  }
  ASSERT_TRUE(writer.close());
  std::ofstream(folder_ / "lepton.yaml")
      << "thermal: {model: lepton3}\nperception:\n"
         "  thermal_detection: {model: box.onnx, classes: person, strides: \"16\"}\n";
  const Outcome o = label_with({folder_ / "corrected", "--config", folder_ / "lepton.yaml", "--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_EQ(o.json()["correcting"], 10);
  EXPECT_EQ(o.json()["thermal_detection"]["pictures"], 5);
}

TEST_F(LabelCommand, WithoutAFolderItOnlySaysWhatItSaw) {
  const Outcome o = label_with({recording_, "--config", all_networks()});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("segmentation: 3 pictures"));
  EXPECT_THAT(o.out, HasSubstr("person 100.0 %"));
  EXPECT_THAT(o.out, HasSubstr("3 car"));
  EXPECT_FALSE(fs::exists(fs::path(recording_) / "labels"));
}

TEST_F(LabelCommand, WhatIsThereIsReplacedOnlyWhenTold) {
  const std::vector<std::string> arguments{recording_, "--config", all_networks(), "--out", recording_};
  fs::create_directory(fs::path(recording_) / "labels");
  std::ofstream(fs::path(recording_) / "labels/5.png") << "the simulator's";
  const Outcome refused = label_with(arguments);
  EXPECT_EQ(refused.exit_code, app::kWrongArguments);
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_TRUE(fs::exists(fs::path(recording_) / "labels/5.png"));
  auto told = arguments;
  told.emplace_back("--overwrite");
  EXPECT_EQ(label_with(told).exit_code, app::kDone);
  EXPECT_FALSE(fs::exists(fs::path(recording_) / "labels/5.png"));
  EXPECT_TRUE(fs::exists(fs::path(recording_) / "boxes.csv"));
}

TEST_F(LabelCommand, AModelThatIsMissingIsNamedAndNothingIsWritten) {
  const Outcome o =
      label_with({recording_, "--config", profile("  detection: {model: none.onnx}\n"), "--out", folder_ / "out"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("perception.detection: none.onnx"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(LabelCommand, AProfileWithoutNetworksSaysWhatToDo) {
  const Outcome o = label_with({recording_});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("perception.segmentation.model"));
  EXPECT_EQ(label_with({recording_, "--config", all_networks(), "--overlay"}).exit_code, app::kWrongArguments);
}

TEST_F(LabelCommand, InspectSaysWhatWasKeptAndWhatIsDamaged) {
  ASSERT_EQ(label_with({recording_, "--config", all_networks(), "--out", recording_}).exit_code, app::kDone);
  const auto whole = run(add_inspect_command, {"inspect", recording_, "--json"}).json();
  EXPECT_EQ(whole["labels"]["pictures"], 3);
  EXPECT_EQ(whole["labels"]["sizes"][0], "6x4");
  EXPECT_EQ(whole["labels"]["share"]["person"], 1.0);
  EXPECT_EQ(whole["boxes"]["pictures"]["thermal"], 3);
  EXPECT_EQ(whole["boxes"]["boxes"]["car"], 3);
  EXPECT_EQ(whole["damaged"], 0);
  std::ofstream(fs::path(recording_) / "labels/200000000.png") << "no picture";
  std::ofstream(fs::path(recording_) / "boxes.csv", std::ios::app) << "1,";
  const auto damaged = run(add_inspect_command, {"inspect", recording_, "--json"}).json();
  EXPECT_EQ(damaged["labels"]["pictures"], 2);
  EXPECT_EQ(damaged["damaged"], 2);
  EXPECT_THAT(damaged["damage"][0].get<std::string>(), HasSubstr("labels/200000000.png"));
}

TEST_F(LabelCommand, ADamagedPictureIsLeftOutAndCounted) {
  std::ofstream(fs::path(recording_) / "camera/data/200000000.png") << "no picture";
  const Outcome o = label_with({recording_, "--config", all_networks(), "--json"});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_EQ(o.json()["damaged"], 1);
  EXPECT_EQ(o.json()["segmentation"]["pictures"], 2);
}

}  // namespace
}  // namespace cairn::cli
