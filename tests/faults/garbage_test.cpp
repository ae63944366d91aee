// SPDX-License-Identifier: Apache-2.0
// Packets of the right size and with wrong contents from the sensor's own address, which no filter of senders keeps
// out: seen from the whole program.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string_view>

#include "drivers/recording/recording_writer.hpp"
#include "hal/bytes.hpp"
#include "onboard/app/run.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;

constexpr double kSeconds = 8;
constexpr Duration kGarbageBegins = 3s, kGarbageEnds = 5s;
const Vector6 kMountOnTop = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();

/// Makes packets of the time in which garbage comes from a true one.
using Spoil = std::function<std::vector<Packet>(const Packet&, std::mt19937&)>;

void put(Packet& packet, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) packet.bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
}

/// Any bytes at all.
Packet noise(Packet packet, std::mt19937& random) {
  for (std::byte& b : packet.bytes) b = static_cast<std::byte>(random());
  return packet;
}

/// Right flags, model and return mode; azimuths, time and points are noise.
Packet dressed_noise(const Packet& packet, std::mt19937& random) {
  Packet made = noise(packet, random);
  for (std::size_t b = 0; b < velodyne::kBlocks; ++b) {
    put(made, b * velodyne::kBlockBytes, velodyne::kBlockFlag, 2);
    put(made, b * velodyne::kBlockBytes + 2, random() % 36'000, 2);
  }
  put(made, velodyne::kTimestampOffset, random() % 3'600'000'000U, 4);
  put(made, velodyne::kReturnModeOffset, 0x2237, 2);
  return made;
}

/// Everything is right but the distances.
Packet wrong_distances(Packet packet, std::mt19937& random) {
  for (std::size_t b = 0; b < velodyne::kBlocks; ++b)
    for (std::size_t s = 0; s < velodyne::kBlockChannels; ++s)
      put(packet, b * velodyne::kBlockBytes + 4 + 3 * s, random() % 30'000, 2);
  return packet;
}

/// A sensor that counts another time.
Packet wrong_time(Packet packet, std::mt19937& random) {
  put(packet, velodyne::kTimestampOffset, random() % 3'600'000'000U, 4);
  return packet;
}

recording::RecordingWriter lidar_recording(const std::filesystem::path& folder) {
  recording::Recording index;
  index.robot = "husky_1";
  index.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16", kMountOnTop});
  return recording::RecordingWriter::create(folder, index).value();
}

bool record(const std::filesystem::path& folder, const support::Vlp16Drive& drive, const Spoil& spoil) {
  auto writer = lidar_recording(folder);
  std::mt19937 random(1);
  const Time start = drive.packets().front().arrival;
  for (const Packet& packet : drive.packets()) {
    const Duration age = packet.arrival - start;
    const bool spoilt = age >= kGarbageBegins && age < kGarbageEnds;
    for (const Packet& sent : spoilt ? spoil(packet, random) : std::vector<Packet>{packet})
      if (!writer.write(sent)) return false;
  }
  return writer.close().has_value();
}

struct Outcome {
  Measured measured;
  double error_m = 0;  // of the last pose
};

Outcome replay_with(const Spoil& spoil) {
  const support::TemporaryFolder folder;
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOnTop), kSeconds, 1);
  Outcome outcome;
  app::RunOptions options;
  options.recording = folder / "recording";
  options.out = folder / "out";
  options.pace = app::Pace::kMaximum;
  if (!record(folder / "recording", drive, spoil)) return outcome.measured.held = false, outcome;
  const auto result = app::run(options);
  if (!result) return outcome.measured.held = false, outcome;
  Measured& m = outcome.measured;
  const Time start = drive.packets().front().arrival;
  for (const Event& e : (*result)->monitor.events()) {
    if (e.stage != "safety") continue;
    if (e.what.starts_with("fault: ") && !m.detect) m.detect = e.first - (start + kGarbageBegins);
    if (e.what.starts_with("ended: ")) m.recover = std::max(m.recover.value_or(0ms), e.last - (start + kGarbageEnds));
    if (e.what == "mode: degraded") m.worst = std::max(m.worst, safety::Mode::kDegraded);
    if (e.what == "mode: hold") m.worst = std::max(m.worst, safety::Mode::kHold);
  }
  const auto& track = (*result)->report.trajectory;
  m.held = !track.empty() && (*result)->report.mode == "normal";
  if (track.empty()) return outcome;
  const auto& first = track.front();
  const auto& last = track.back();
  const SE3 moved = first.T_odom_base.mean.inverse() * last.T_odom_base.mean;
  const SE3 truth = drive.truth(first.stamp).inverse() * drive.truth(last.stamp);
  outcome.error_m = (moved.translation() - truth.translation()).norm();
  return outcome;
}

Spoil instead(Packet (*make)(Packet, std::mt19937&)) {
  return [make](const Packet& packet, std::mt19937& random) { return std::vector<Packet>{make(packet, random)}; };
}

struct Garbage {
  const char* name;
  Spoil spoil;
};
std::vector<Garbage> kinds() {
  const auto beside = [](auto make) {
    return [make](const Packet& packet, std::mt19937& random) {
      return std::vector<Packet>{make(packet, random), packet, make(packet, random)};
    };
  };
  return {{"noise_beside", beside(noise)},
          {"dressed_noise_beside", beside([](const Packet& p, std::mt19937& r) { return dressed_noise(p, r); })},
          {"dressed_noise_instead", [](const Packet& p, std::mt19937& r) { return std::vector{dressed_noise(p, r)}; }},
          {"wrong_time_beside", beside(wrong_time)},
          {"wrong_time_instead", instead(wrong_time)},
          {"wrong_distances_beside", beside(wrong_distances)},
          {"wrong_distances_instead", instead(wrong_distances)}};
}

Garbage kind(const char* name) {
  const auto all = kinds();
  return *std::ranges::find_if(all, [&](const Garbage& garbage) { return std::string_view(garbage.name) == name; });
}

class GarbageTest : public testing::TestWithParam<Garbage> {};

TEST_P(GarbageTest, OdometryIsFoundAgainAfterwards) {
  const Outcome outcome = replay_with(GetParam().spoil);
  EXPECT_TRUE(outcome.measured.held);
  EXPECT_LT(outcome.error_m, 0.1);
}

INSTANTIATE_TEST_SUITE_P(FullKinds, GarbageTest, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });
// Two of them: stamps that mislead the clock, and points that mislead odometry.
INSTANTIATE_TEST_SUITE_P(Kinds, GarbageTest,
                         testing::Values(kind("wrong_time_beside"), kind("wrong_distances_instead")),
                         [](const auto& garbage) { return garbage.param.name; });

/// A recorder that was stopped and started again: virtual time jumps over the pause, and what was known is known still.
TEST(LongPause, IsJumpedOverAndTheRobotGoesOn) {
  const support::TemporaryFolder folder;
  support::Scene standing = support::lobby();
  standing.ride.max_speed = 0;
  const support::Vlp16Drive drive(standing, SE3::from_xyz_rpy(kMountOnTop), 3, 1);
  constexpr Duration kPause = 10h + 15min;
  constexpr std::uint64_t kPast_us = 900'000'000;  // of the hour that the sensor counts
  const Time half = drive.packets()[drive.packets().size() / 2].arrival;
  auto writer = lidar_recording(folder / "recording");
  for (Packet packet : drive.packets()) {
    if (packet.arrival >= half) {
      packet.arrival += kPause;
      const auto device_us = load_le<std::uint32_t>(packet.bytes, velodyne::kTimestampOffset);
      put(packet, velodyne::kTimestampOffset, (device_us + kPast_us) % velodyne::kMicrosecondsPerHour, 4);
    }
    ASSERT_TRUE(writer.write(packet));
  }
  ASSERT_TRUE(writer.close());
  app::RunOptions options;
  options.recording = folder / "recording";
  options.out = folder / "out";
  options.pace = app::Pace::kMaximum;
  const auto result = app::run(options);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_EQ((*result)->report.mode, "normal");
  const auto& events = (*result)->monitor.events();
  EXPECT_TRUE(std::ranges::any_of(events, [](const Event& e) { return e.what.find("jumped over 36") != e.what.npos; }));
  const auto& track = (*result)->report.trajectory;
  ASSERT_GT(track.size(), 20U);
  EXPECT_GT(track.back().stamp - track.front().stamp, kPause);
  EXPECT_LT(track.back().T_odom_base.mean.translation().norm(), 0.1) << "the robot stood";
}

}  // namespace

std::vector<Row> garbage_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal, D = safety::Mode::kDegraded;
  return {{"L21", "single packets of a recording have stamps years away",
           "They are set aside and named. A replay at full speed jumps over long silence.", 0ms, 0ms, N,
           "recording/GuardedSource.SetsSingleAbsurdStampsAsideAndNamesThemOnce"},
          {"L22", "2 s of packets with right headers and random distances, from the sensor's own address",
           "Scans that do not fit stay out of the map. Odometry is found again, with an error below 0.1 m.", 500ms, 1s,
           D, "",
           [] {
             Outcome outcome = replay_with(instead(wrong_distances));
             outcome.measured.held = outcome.measured.held && outcome.error_m < 0.1;
             return outcome.measured;
           }},
          {"L23", "other senders flood the LiDAR's port",
           "The kernel drops their datagrams. No packet of the sensor is lost. They are counted.", 0ms, 0ms, N,
           "velodyne/UdpSourceTest.TheFirstSenderOfValidPacketsIsHeardAlone"}};
}

}  // namespace cairn::faults
