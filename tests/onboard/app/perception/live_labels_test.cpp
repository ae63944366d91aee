// SPDX-License-Identifier: Apache-2.0
// A live run asks a network what its pictures show, and keeps the answers. What it recorded, played again without the
// network, is the same run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

#include "onboard/app/run.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"
#include "tests/onboard/app/perception/labelled_room.hpp"
#include "tests/onboard/app/room_run.hpp"
#include "tests/onboard/perception/networks/tiny_onnx.hpp"

namespace cairn::app {
namespace {

/// Knows the greys of labelled_room.hpp: the plane of class k is largest where x = k, for x = (grey - 30) / 50.
networks::test::TinyOnnx reader_of_greys() {
  std::vector<std::vector<float>> weights;
  std::vector<float> biases;
  for (int k = 0; k < 4; ++k) {
    weights.push_back({20.0F * static_cast<float>(k), 0, 0});
    biases.push_back(-10.0F * static_cast<float>(k * k));
  }
  return networks::test::convolution(test::kEyeColumns, test::kEyeRows, weights, biases)
      .output("planes", {1, 4, test::kEyeRows, test::kEyeColumns});
}

std::size_t files_in(const test::fs::path& folder) {
  std::error_code missing;
  return static_cast<std::size_t>(std::distance(test::fs::directory_iterator(folder, missing), {}));
}

class LiveLabels : public test::RoomRun {
 protected:
  static void SetUpTestSuite() {
    RoomRun::SetUpTestSuite();
    test::record_pictures(*folder_ / "recording");
    test::fs::remove_all(*folder_ / "recording" / "labels");  // the network is to say it
    reader_of_greys().save(*folder_ / "greys.onnx");
    std::string profile = test::kLabelledProfile;
    const std::string without = "rate_hz: 20";
    profile.replace(profile.find(without), without.size(),
                    "rate_hz: 20, model: greys.onnx, mean: [30, 30, 30], std: [50, 50, 50], classes: identity");
    write("profile.yaml", profile + "team: {id: 1, socket: " + (*folder_ / "p.sock").string() + "}\n");
  }

  /// The recording is played as if by devices until the robot has used all of its scans, and a label is on the disk.
  static Result<std::unique_ptr<RunResult>> run_live(RunOptions options) {
    std::atomic<std::size_t> located = 0;
    options.progress = [&](Time, std::size_t scans) { located = scans; };
    options.stop = [&] { return located >= test::kScans && files_in(options.record / networks::kLabelFolder) > 0; };
    options.seconds = 20;
    return run(options);
  }
  /// A busy machine drops scans and pictures, as it must. Then the robot drives anew.
  static Result<std::unique_ptr<RunResult>> run_until_labelled(const RunOptions& options) {
    auto result = run_live(options);
    for (int i = 0; i < 100 && result && (*result)->report.map.labelled <= kLeastLabelled; ++i) {
      test::fs::remove_all(options.record);
      result = run_live(options);
    }
    return result;
  }
  static constexpr std::uint64_t kLeastLabelled = 300;
};

TEST_F(LiveLabels, AreRepeatedToTheBitWithoutTheNetwork) {
  RunOptions live = options("live");
  live.config = *folder_ / "profile.yaml";
  live.peers = true;
  live.pace = Pace::kLive;
  live.record = *folder_ / "kept";
  const auto result = run_until_labelled(live);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& ran = (*result)->report;
  ASSERT_TRUE(ran.labels);
  EXPECT_GT(ran.labels->images, 0U);
  EXPECT_GT(ran.map.labelled, kLeastLabelled);

  test::fs::remove(*folder_ / "greys.onnx");
  for (const int threads : {1, 2, 4}) {
    RunOptions again = options("again");
    again.recording = live.record;
    again.networks = NetworkUse::kRecorded;
    again.threads = threads;
    const auto repeated = run(again);
    ASSERT_TRUE(repeated) << to_string(repeated.error());
    EXPECT_EQ((*repeated)->report.output_sha256, ran.output_sha256) << threads << " threads";
    EXPECT_EQ((*repeated)->report.map.labelled, ran.map.labelled);
    EXPECT_EQ((*repeated)->report.labels->images, ran.labels->images);
  }
}

}  // namespace
}  // namespace cairn::app
