// SPDX-License-Identifier: Apache-2.0
// Interrupts and kills the real program at random instants of a replay. CAIRN_INTERRUPTS: how often the slow tests do
// each of the two (10 without).
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/clock.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/faults/cairn_child.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::faults {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr double kRecorded_s = 2;
constexpr long kFew = 2;

long interrupts() {
  const char* text = std::getenv("CAIRN_INTERRUPTS");
  return text != nullptr ? std::strtol(text, nullptr, 10) : 10;
}

void record_drive(const fs::path& folder) {
  const Vector6 mount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
  recording::Recording index;
  index.robot = "husky_1";
  index.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16", mount});
  auto writer = recording::RecordingWriter::create(folder, index);
  ASSERT_TRUE(writer) << to_string(writer.error());
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(mount), kRecorded_s, 1);
  for (const Packet& packet : drive.packets()) ASSERT_TRUE(writer->write(packet));
  ASSERT_TRUE(writer->close());
}

std::string text_of(const fs::path& file) {
  const auto bytes = read_file(file, 1 << 24);
  EXPECT_TRUE(bytes) << to_string(bytes.error());
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

/// Every file of a run is there and whole. Returns its report.
Json whole_results(const fs::path& out) {
  for (const char* map : {"map.cairn", "map.ot"}) {
    const auto loaded = mapping::load_map(out / map);
    EXPECT_TRUE(loaded) << to_string(loaded.error());
  }
  const auto track = recording::read_tum(out / "trajectory.tum");
  EXPECT_TRUE(track) << to_string(track.error());
  const auto profile = app::load_profile(out / "config.yaml");
  EXPECT_TRUE(profile) << to_string(profile.error());
  EXPECT_TRUE(text_of(out / "report.html").ends_with("</html>\n"));
  Json report = Json::parse(text_of(out / "report.json"), nullptr, false);
  EXPECT_TRUE(report.is_object());
  if (!track || !report.is_object()) return report;
  EXPECT_LE(track->size(), report["scans"].get<std::size_t>());
  EXPECT_GE(track->size() + 2, report["scans"].get<std::size_t>()) << "the first and the last may be parts of one";
  return report;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

class OutputCampaign : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    record_drive(*folder_ / "recording");
    const LiveClock clock;
    const Time begin = clock.now();
    CairnChild whole(run_into("whole", "max"), *folder_ / "said.txt");
    ASSERT_EQ(whole.wait(), 0) << whole.said();
    whole_s_ = to_seconds(clock.now() - begin);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::vector<std::string> run_into(const std::string& out, const std::string& speed) {
    return {"run", "--recording", *folder_ / "recording", "--out", *folder_ / out, "--speed", speed};
  }
  /// From its first sign on the disk: before, there is nothing to lose.
  static void wait_at_random(CairnChild& child, const fs::path& out, double span_s) {
    const LiveClock clock;
    std::error_code ignored;
    while (!child.ended() && (!fs::exists(out, ignored) || fs::is_empty(out, ignored)))
      LiveClock::wait_until(clock.now() + 1ms);
    const auto span_us = static_cast<std::uint64_t>(1e6 * span_s);
    LiveClock::wait_until(clock.now() + std::chrono::microseconds(random_() % span_us));
  }

  static void interrupt_again_and_again(long interrupts);
  static void kill_again_and_again(long kills);
  static void kill_copies_again_and_again(long kills);

  static inline std::optional<support::TemporaryFolder> folder_;
  static inline double whole_s_ = 0;  // a whole run as fast as possible
  static inline std::mt19937_64 random_{1};
};

void OutputCampaign::interrupt_again_and_again(long interrupts) {
  const Json whole = whole_results(*folder_ / "whole");
  EXPECT_EQ(whole["interrupted"], false);
  long interrupted = 0;
  for (long i = 0; i < interrupts && !HasFailure(); ++i) {
    const bool real = i % 4 == 1;
    const fs::path out = *folder_ / "out";
    fs::remove_all(out);
    CairnChild run(run_into("out", real ? "real" : "max"), *folder_ / "said.txt");
    wait_at_random(run, out, real ? kRecorded_s : whole_s_);
    run.signal(i % 2 == 0 ? SIGINT : SIGTERM);
    LiveClock::wait_until(LiveClock().now() + std::chrono::microseconds(random_() % 20'000));
    run.signal(SIGINT);  // as from a supervisor that signals a program and then its group
    const int code = run.wait();
    const Json report = whole_results(out);
    const bool marked = report["interrupted"].get<bool>();
    interrupted += marked ? 1 : 0;
    EXPECT_EQ(code, marked ? 1 : 0) << run.said();
    EXPECT_EQ(run.said().find("interrupted") != std::string::npos, marked) << run.said();
    EXPECT_EQ(text_of(out / "report.html").find("was interrupted") != std::string::npos, marked);
    EXPECT_LE(report["scans"], whole["scans"]);
    EXPECT_TRUE(marked || report["output_sha256"] == whole["output_sha256"]);
    EXPECT_EQ(names_in(out), names_in(*folder_ / "whole"));
  }
  std::cout << interrupted << " of " << interrupts << " runs were interrupted before their end\n";
}

void OutputCampaign::kill_again_and_again(long kills) {
  const fs::path out = *folder_ / "whole";
  const auto files = names_in(out);
  for (long i = 0; i < kills && !HasFailure(); ++i) {
    CairnChild run(run_into("whole", "max"), *folder_ / "said.txt");
    wait_at_random(run, out, 1.1 * whole_s_);
    run.signal(SIGKILL);
    (void)run.wait();
    EXPECT_EQ(whole_results(out)["interrupted"], false);
  }
  CairnChild last(run_into("whole", "max"), *folder_ / "said.txt");
  EXPECT_EQ(last.wait(), 0) << last.said();
  EXPECT_EQ(names_in(out), files) << "what the killed ones left is removed";
}

std::uint64_t packets_in(const fs::path& recording) {
  auto reader = recording::RecordingReader::open(recording);
  EXPECT_TRUE(reader) << to_string(reader.error());
  std::uint64_t packets = 0;
  Packet packet;
  while (reader && (*reader)->next(packet, {}).value_or(Poll::kEnd) != Poll::kEnd) ++packets;
  return packets;
}

/// Whatever was killed: what does not say that it is unfinished is whole, and only that lies in the copy's place.
void OutputCampaign::kill_copies_again_and_again(long kills) {
  const fs::path original = *folder_ / "recording", place = *folder_ / "copies" / "copy";
  const std::vector<std::string> words{"faults", original, "--out", place, "--overwrite"};
  const LiveClock clock;
  const Time begin = clock.now();
  ASSERT_EQ(CairnChild(words, *folder_ / "said.txt").wait(), 0);
  const auto span_us = static_cast<std::uint64_t>(1.2e6 * to_seconds(clock.now() - begin));
  for (long i = 0; i < kills; ++i) {
    CairnChild copying(words, *folder_ / "said.txt");
    LiveClock::wait_until(clock.now() + std::chrono::microseconds(random_() % span_us));
    copying.signal(SIGKILL);
    (void)copying.wait();
  }
  const auto copy = recording::load_recording(place);
  EXPECT_TRUE(copy && !copy->unfinished);
  for (const auto& entry : fs::directory_iterator(place.parent_path())) {
    EXPECT_TRUE(entry.path().filename().string().starts_with("copy")) << entry.path();
    const auto index = recording::load_recording(entry.path());
    if (!index || index->unfinished) continue;
    EXPECT_EQ(packets_in(entry.path()), packets_in(original)) << entry.path();
  }
}

class FullOutputCampaign : public OutputCampaign {};

TEST_F(OutputCampaign, AnInterruptedReplayLeavesAllItsFilesMarked) { interrupt_again_and_again(kFew); }
TEST_F(FullOutputCampaign, AnInterruptedReplayLeavesAllItsFilesMarked) { interrupt_again_and_again(interrupts()); }
TEST_F(OutputCampaign, AKilledReplayLeavesTheEarlierResults) { kill_again_and_again(kFew); }
TEST_F(OutputCampaign, AKilledCopyIsNoHalfRecording) { kill_copies_again_and_again(4 * kFew); }
TEST_F(FullOutputCampaign, AKilledCopyIsNoHalfRecording) { kill_copies_again_and_again(interrupts()); }
TEST_F(FullOutputCampaign, AKilledReplayLeavesTheEarlierResults) { kill_again_and_again(interrupts()); }

}  // namespace
}  // namespace cairn::faults
