// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

class Simulate : public ::testing::Test {
 protected:
  [[nodiscard]] SimulationConfig config(const std::string& name, std::uint64_t seed = 1) const {
    SimulationConfig c;
    c.scene = "corridor";
    c.seconds = 0.7;
    c.seed = seed;
    c.out = dir_ / name;
    return c;
  }
  [[nodiscard]] std::vector<std::byte> bytes(const std::string& file) const {
    auto read = read_file(dir_ / file, std::uint64_t{1} << 30);
    EXPECT_TRUE(read) << file;
    return read ? *read : std::vector<std::byte>{};
  }

  support::TemporaryFolder dir_;
};

TEST_F(Simulate, WritesARecordingThatOthersCanRead) {
  SimulationConfig c = config("out");
  c.robots = 2;
  const auto robots = simulate(c);
  ASSERT_TRUE(robots) << to_string(robots.error());
  ASSERT_EQ(robots->size(), 2u);
  for (const RobotSummary& r : *robots) {
    const auto index = recording::load_recording(c.out / r.name);
    ASSERT_TRUE(index) << to_string(index.error());
    EXPECT_EQ(index->robot, r.name);
    ASSERT_EQ(index->sources.size(), 1u);
    EXPECT_EQ(index->sources[0].model, "VLP-16");
    EXPECT_TRUE(index->sources[0].base_sensor_xyz_rpy);
    const auto truth = recording::read_tum(c.out / r.name / "ground_truth.tum");
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->front().stamp + std::chrono::milliseconds(10), (*truth)[1].stamp);
    EXPECT_GE(truth->back().stamp - truth->front().stamp, from_seconds(c.seconds));
    EXPECT_EQ(r.data_packets, static_cast<std::uint64_t>((c.seconds - 0.0001) / 0.001327104));
    EXPECT_NEAR(static_cast<double>(r.data_packets) / static_cast<double>(r.position_packets), 14.0, 0.2);
    // 24-byte header; per packet a record header of 16 and 42 bytes of Ethernet, IP and UDP
    EXPECT_EQ(fs::file_size(c.out / r.name / "lidar.pcap"),
              24 + r.data_packets * (16 + 42 + 1206) + r.position_packets * (16 + 42 + 512));
  }
  EXPECT_EQ(bytes("out/robot_1/world.ot"), bytes("out/robot_2/world.ot"));
  EXPECT_NE(bytes("out/robot_1/ground_truth.tum"), bytes("out/robot_2/ground_truth.tum"));
}

TEST_F(Simulate, SameSeedGivesTheSameBytesForAnyNumberOfThreads) {
  SimulationConfig two_threads = config("c"), with_company = config("d");
  two_threads.threads = 2;
  with_company.robots = 2;
  ASSERT_TRUE(simulate(config("a")));
  ASSERT_TRUE(simulate(config("b")));
  ASSERT_TRUE(simulate(two_threads));
  ASSERT_TRUE(simulate(with_company));
  for (const char* file : {"recording.yaml", "lidar.pcap", "ground_truth.tum", "world.ot"}) {
    const auto expected = bytes(std::string("a/robot_1/") + file);
    EXPECT_FALSE(expected.empty());
    for (const char* other : {"b", "c", "d"})
      EXPECT_TRUE(expected == bytes(std::string(other) + "/robot_1/" + file)) << other << ' ' << file;
  }
}

TEST_F(Simulate, AnotherSeedGivesOtherPathsAndNoiseInTheSameWorld) {
  ASSERT_TRUE(simulate(config("a", 1)));
  ASSERT_TRUE(simulate(config("b", 2)));
  EXPECT_NE(bytes("a/robot_1/lidar.pcap"), bytes("b/robot_1/lidar.pcap"));
  EXPECT_NE(bytes("a/robot_1/ground_truth.tum"), bytes("b/robot_1/ground_truth.tum"));
  EXPECT_EQ(bytes("a/robot_1/world.ot"), bytes("b/robot_1/world.ot"));
}

TEST_F(Simulate, PeopleAreSeenByTheLidarAndToldInACsv) {
  SimulationConfig crowded = config("crowded");
  crowded.people.count = 5;
  crowded.threads = 2;
  SimulationConfig again = crowded;
  again.out = dir_ / "again";
  again.threads = 1;
  ASSERT_TRUE(simulate(crowded));
  ASSERT_TRUE(simulate(again));
  ASSERT_TRUE(simulate(config("empty")));
  EXPECT_EQ(bytes("crowded/robot_1/lidar.pcap"), bytes("again/robot_1/lidar.pcap"));
  EXPECT_EQ(bytes("crowded/robot_1/people.csv"), bytes("again/robot_1/people.csv"));
  EXPECT_NE(bytes("crowded/robot_1/lidar.pcap"), bytes("empty/robot_1/lidar.pcap"));
  EXPECT_EQ(bytes("crowded/robot_1/ground_truth.tum"), bytes("empty/robot_1/ground_truth.tum"));
  EXPECT_EQ(bytes("crowded/robot_1/world.ot"), bytes("empty/robot_1/world.ot"));
  EXPECT_FALSE(fs::exists(dir_ / "empty/robot_1/people.csv"));
}

/// All files below a folder, by their names in it.
std::vector<std::string> files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// In one scene, everything a Husky carries, with a coarse camera so that the test is fast.
class SimulateIn : public Simulate, public ::testing::WithParamInterface<const char*> {
 protected:
  [[nodiscard]] SimulationConfig with_all_sensors(const std::string& name) const {
    SimulationConfig c = config(name);
    c.scene = GetParam();
    c.people.count = 3;
    c.sensors = Sensors::all();
    c.stereo.lens = {84, 46, 44, 44, 42, 23};
    c.depth.lens = {106, 60, 54, 54, 53, 30};
    return c;
  }
};

INSTANTIATE_TEST_SUITE_P(Scenes, SimulateIn, ::testing::Values("corridor"));
INSTANTIATE_TEST_SUITE_P(FullScenes, SimulateIn, ::testing::Values("street"));

TEST_P(SimulateIn, EverySensorsPacketsReadBackInTheOrderOfArrival) {
  const SimulationConfig c = with_all_sensors("out");
  const auto robots = simulate(c);
  ASSERT_TRUE(robots) << to_string(robots.error());
  const RobotSummary& r = robots->front();
  const fs::path dir = c.out / "robot_1";
  auto reader = recording::RecordingReader::open(dir);
  ASSERT_TRUE(reader) << to_string(reader.error());
  const std::pair<std::string_view, std::uint64_t> expected[] = {{"lidar", r.data_packets + r.position_packets},
                                                                 {"camera", r.camera_frames},
                                                                 {"thermal", r.thermal_frames},
                                                                 {"depth", r.depth_frames},
                                                                 {"drive", r.can_frames},
                                                                 {"gpio", r.line_events}};
  std::map<std::string, std::uint64_t> counted;
  Packet packet;
  Time last{};
  for (;;) {
    const auto poll = (*reader)->next(packet, Duration::zero());
    ASSERT_TRUE(poll) << to_string(poll.error());
    if (*poll == Poll::kEnd) break;
    if (*poll != Poll::kPacket) continue;
    EXPECT_GE(packet.arrival, last);
    last = packet.arrival;
    ++counted[(*reader)->recording().sources[static_cast<std::size_t>(packet.source)].id];
  }
  for (const auto& [id, packets] : expected) {
    EXPECT_EQ(counted[std::string(id)], packets) << id;
    EXPECT_GT(packets, 5U) << id;
  }
  EXPECT_EQ(bytes("out/robot_1/lidar_labels.bin").size(), 384 * r.data_packets);
  EXPECT_EQ(files(dir / "labels").size(), r.camera_frames);
}

/// The pictures of one source, decoded.
std::vector<Image> pictures_of(const fs::path& recorded, const std::string& id, int width, int height) {
  auto reader = recording::RecordingReader::open(recorded).value();
  camera::Config config;
  config.capture.width = width;
  config.capture.height = height;
  auto decoder = camera::Camera::create(config).value();
  std::vector<Image> pictures;
  Packet packet;
  while (reader->next(packet, Duration::zero()).value() != Poll::kEnd) {
    if (reader->recording().sources[static_cast<std::size_t>(packet.source)].id != id) continue;
    const auto picture = decoder.decode(packet);
    EXPECT_TRUE(picture) << to_string(picture.error());
    if (picture) pictures.push_back(**picture);
  }
  return pictures;
}

TEST_P(SimulateIn, SeparateEyesAreTheHalvesOfThePair) {
  SimulationConfig pair = with_all_sensors("pair"), apart = with_all_sensors("apart");
  pair.sensors = apart.sensors = {false, true, false, false, false, false};
  apart.stereo.separate_eyes = true;
  ASSERT_TRUE(simulate(pair));
  ASSERT_TRUE(simulate(apart));
  const auto both = pictures_of(dir_ / "pair/robot_1", "camera", 168, 46);
  const auto left = pictures_of(dir_ / "apart/robot_1", "camera", 84, 46);
  const auto right = pictures_of(dir_ / "apart/robot_1", "camera_right", 84, 46);
  ASSERT_GT(both.size(), 5U);
  ASSERT_EQ(left.size(), both.size());
  ASSERT_EQ(right.size(), both.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto eyes = camera::split_side_by_side(both[i].view());
    ASSERT_TRUE(eyes);
    EXPECT_EQ(left[i].stamp, right[i].stamp);
    for (int row = 0; row < 46; ++row) {
      EXPECT_TRUE(std::ranges::equal(left[i].view().row(row), eyes->left.row(row)));
      EXPECT_TRUE(std::ranges::equal(right[i].view().row(row), eyes->right.row(row)));
    }
  }
  EXPECT_EQ(bytes("pair/robot_1/world.ot"), bytes("apart/robot_1/world.ot"));
}

TEST_P(SimulateIn, AllSensorsGiveTheSameBytesForAnyNumberOfThreadsAndLeaveTheLidarAlone) {
  SimulationConfig two_threads = with_all_sensors("b"), lidar_alone = with_all_sensors("c");
  two_threads.threads = 2;
  lidar_alone.sensors = Sensors{};
  ASSERT_TRUE(simulate(with_all_sensors("a")));
  ASSERT_TRUE(simulate(two_threads));
  ASSERT_TRUE(simulate(lidar_alone));
  const auto names = files(dir_ / "a");
  EXPECT_GT(names.size(), 40U);
  EXPECT_EQ(names, files(dir_ / "b"));
  for (const std::string& name : names) EXPECT_TRUE(bytes("a/" + name) == bytes("b/" + name)) << name;
  for (const char* same : {"lidar.pcap", "ground_truth.tum", "world.ot", "people.csv"})
    EXPECT_TRUE(bytes(std::string("a/robot_1/") + same) == bytes(std::string("c/robot_1/") + same)) << same;
}

TEST_P(SimulateIn, AUavCarriesTheCameraAlone) {
  SimulationConfig c = with_all_sensors("uav");
  c.profile = "uav";
  EXPECT_EQ(simulate(c).error().code, Errc::kInvalidConfig);
  make_uav(c);
  const auto robots = simulate(c);
  ASSERT_TRUE(robots) << to_string(robots.error());
  EXPECT_GT(robots->front().camera_frames, 5U);
  const auto truth = recording::read_tum(c.out / "robot_1" / "ground_truth.tum");
  ASSERT_TRUE(truth);
  for (const recording::StampedPose& p : *truth) EXPECT_GT(p.pose.translation().z(), 1.5);
  EXPECT_FALSE(fs::exists(c.out / "robot_1" / "lidar.pcap"));
}

TEST_F(Simulate, TellsItsProgress) {
  std::vector<double> told;
  ASSERT_TRUE(simulate(config("out"), [&](double done) { told.push_back(done); }));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
}

TEST_F(Simulate, RefusesWhatCannotBe) {
  SimulationConfig c = config("out");
  c.scene = "moon";
  EXPECT_EQ(simulate(c).error().code, Errc::kInvalidConfig);
  EXPECT_THAT(simulate(c).error().detail, ::testing::HasSubstr("forest"));
  c = config("out");
  c.robots = 0;
  EXPECT_EQ(simulate(c).error().code, Errc::kInvalidConfig);
  c = config("out");
  c.seconds = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(simulate(c).error().code, Errc::kInvalidConfig);
  EXPECT_FALSE(fs::exists(dir_ / "out"));
}

TEST_F(Simulate, LeavesWhatIsThereAlone) {
  fs::create_directories(dir_ / "out");
  std::ofstream(dir_ / "out" / "precious.txt") << "precious";
  const auto robots = simulate(config("out"));
  ASSERT_FALSE(robots);
  EXPECT_EQ(robots.error().code, Errc::kIo);
  EXPECT_EQ(robots.error().where, (dir_ / "out").string());
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_ / "out"), fs::directory_iterator()), 1);
}

TEST_F(Simulate, SaysWhereItCannotWrite) {
  std::ofstream(dir_ / "file") << "not a folder";
  const auto robots = simulate(config("file/out"));
  ASSERT_FALSE(robots);
  EXPECT_EQ(robots.error().code, Errc::kIo);
}

TEST_F(Simulate, AFullDiskLeavesNoHalfRecording) {
  // A limit on the size of files stands in for a disk without room.
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = old;
  tight.rlim_cur = 300'000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const auto robots = simulate(config("out"));
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(robots);
  EXPECT_EQ(robots.error().code, Errc::kIo);
  EXPECT_THAT(to_string(robots.error()), ::testing::HasSubstr("lidar.pcap"));
  EXPECT_FALSE(fs::exists(dir_ / "out" / "robot_1"));
}

}  // namespace
}  // namespace cairn::simulator
