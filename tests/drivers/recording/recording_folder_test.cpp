// SPDX-License-Identifier: Apache-2.0
// RecordingWriter and RecordingReader: what one writes, the other hands out.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "drivers/recording/stamp_guard.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr std::int64_t kOffset = 1'700'000'000'000'000'123;

Recording two_lidars_and_sweeps() {
  Recording r;
  r.robot = "robot_1";
  r.start_utc_ns = kOffset;
  r.realtime_offset_ns = kOffset;
  r.sources.push_back({"front", kVelodyne, "lidar.pcap", "front", "VLP-16"});
  r.sources.push_back({"sweeps", kScans, "data.csv", "base_link", ""});
  r.sources.push_back({"rear", kVelodyne, "rear/lidar.pcap", "rear", "VLP-16"});
  return r;
}

/// Packets as a robot would get them: each source's arrivals never go back.
std::vector<Packet> random_packets(std::size_t n) {
  std::mt19937 random(11);
  std::vector<Packet> packets;
  std::vector<std::uint64_t> sequence(3);
  std::int64_t ns = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Packet p;
    const std::size_t source = random() % 8 == 0 ? 1 : random() % 2 * 2;
    ns += 1 + random() % 1'000'000;
    p.source = static_cast<SourceId>(source);
    p.arrival = Time(Duration(ns));
    p.sequence = sequence[source]++;
    p.channel = source == 1 ? static_cast<std::uint16_t>(random() % 2) : random() % 9 == 0 ? 8308 : 2368;
    p.bytes.resize(source == 1 ? random() % 50 * 20 : random() % 1300);
    p.truncated = source != 1 && random() % 50 == 0;
    for (std::byte& b : p.bytes) b = static_cast<std::byte>(random() & 0xFFU);
    packets.push_back(std::move(p));
  }
  return packets;
}

void write_all(const fs::path& dir, const std::vector<Packet>& packets) {
  auto writer = RecordingWriter::create(dir, two_lidars_and_sweeps());
  ASSERT_TRUE(writer) << to_string(writer.error());
  for (const Packet& p : packets) ASSERT_TRUE(writer->write(p));
  EXPECT_EQ(writer->packets(), packets.size());
  ASSERT_TRUE(writer->close());
}

struct Replayed {
  std::vector<Packet> packets;
  std::vector<std::string> errors;
};

Replayed read_all(const fs::path& dir) {
  Replayed all;
  auto reader = RecordingReader::open(dir);
  EXPECT_TRUE(reader) << to_string(reader.error());
  if (!reader) return all;
  Packet packet;
  for (auto poll = (*reader)->next(packet, {}); !poll || *poll != Poll::kEnd; poll = (*reader)->next(packet, {})) {
    if (!poll)
      all.errors.push_back(to_string(poll.error()));
    else if (*poll == Poll::kPacket)
      all.packets.push_back(packet);
  }
  return all;
}

void expect_same(const Packet& a, const Packet& b) {
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.channel, b.channel);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.arrival, b.arrival);
  EXPECT_EQ(a.truncated, b.truncated);
  EXPECT_EQ(a.bytes, b.bytes);
}

std::string contents(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(dir))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string all;
  for (const fs::path& f : files) all += f.lexically_relative(dir).string() + "\n" + test::slurp(f);
  return all;
}

TEST(RecordingFolder, AReplayHandsOutExactlyWhatWasRecorded) {
  const TemporaryFolder folder;
  const auto packets = random_packets(2000);
  write_all(folder / "r", packets);
  const auto replayed = read_all(folder / "r");
  EXPECT_TRUE(replayed.errors.empty());
  ASSERT_EQ(replayed.packets.size(), packets.size());
  for (std::size_t i = 0; i < packets.size(); ++i) expect_same(replayed.packets[i], packets[i]);
}

TEST(RecordingFolder, SamePacketsSameBytes) {
  const TemporaryFolder folder;
  const auto packets = random_packets(200);
  write_all(folder / "a", packets);
  write_all(folder / "b", packets);
  EXPECT_EQ(contents(folder / "a"), contents(folder / "b"));
}

TEST(RecordingFolder, RecordingAReplayGivesTheSameRecording) {
  const TemporaryFolder folder;
  write_all(folder / "a", random_packets(200));
  write_all(folder / "b", read_all(folder / "a").packets);
  EXPECT_EQ(contents(folder / "a"), contents(folder / "b"));
}

TEST(RecordingFolder, AnExistingRecordingIsNotOverwritten) {
  const TemporaryFolder folder;
  write_all(folder.path(), random_packets(30));
  const std::string before = contents(folder.path());
  const auto refused = RecordingWriter::create(folder.path(), two_lidars_and_sweeps());
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("there is a recording already"));
  EXPECT_EQ(contents(folder.path()), before);
  fs::remove(folder / "recording.yaml");
  EXPECT_FALSE(RecordingWriter::create(folder.path(), two_lidars_and_sweeps())) << "lidar.pcap would be lost";
}

TEST(RecordingFolder, WhatWasFlushedCanBeReadAfterAKill) {
  const TemporaryFolder folder;
  const auto packets = random_packets(100);
  auto writer = RecordingWriter::create(folder / "r", two_lidars_and_sweeps());
  for (std::size_t i = 0; i < 60; ++i) ASSERT_TRUE(writer->write(packets[i]));
  ASSERT_TRUE(writer->flush());
  fs::copy(folder / "r", folder / "killed", fs::copy_options::recursive);
  EXPECT_EQ(read_all(folder / "killed").packets.size(), 60U);
  EXPECT_TRUE(load_recording(folder / "killed")->unfinished);
  ASSERT_TRUE(writer->close());
  EXPECT_FALSE(load_recording(folder / "r")->unfinished);
}

TEST(RecordingFolder, AnUnknownSourceIsAnError) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "r", two_lidars_and_sweeps());
  Packet packet;
  packet.source = SourceId{3};
  EXPECT_FALSE(writer->write(packet));
}

TEST(RecordingFolder, ACaptureCutAnywhereGivesWhatIsWholeAndTheOthersGoOn) {
  const TemporaryFolder folder;
  auto packets = random_packets(12);
  for (Packet& p : packets) p.bytes.resize(std::min<std::size_t>(p.bytes.size(), 20));
  write_all(folder.path(), packets);
  const std::string whole = test::slurp(folder / "lidar.pcap");
  const auto of_front = [](const std::vector<Packet>& all) {
    return std::count_if(all.begin(), all.end(), [](const Packet& p) { return p.source == SourceId{0}; });
  };
  const auto others = static_cast<std::ptrdiff_t>(packets.size()) - of_front(packets);
  std::ptrdiff_t before = 0;
  for (std::size_t n = 0; n <= whole.size(); ++n) {
    test::spit(folder / "lidar.pcap", whole.substr(0, n));
    const auto replayed = read_all(folder.path());
    const auto front = of_front(replayed.packets);
    ASSERT_EQ(static_cast<std::ptrdiff_t>(replayed.packets.size()) - front, others) << n;
    ASSERT_TRUE(front == before || front == before + 1) << n;
    ASSERT_LE(replayed.errors.size(), 1U);
    for (const std::string& e : replayed.errors) ASSERT_THAT(e, HasSubstr("lidar.pcap")) << n;
    // Between two whole records nothing is missing; anywhere else something is, and it is said.
    ASSERT_EQ(replayed.errors.empty(), n >= 24 && (front == before + 1 || n == 24)) << n;
    before = front;
  }
  EXPECT_EQ(before, of_front(packets));
}

TEST(RecordingFolder, ADamagedCaptureIsNamedWithItsOffset) {
  const TemporaryFolder folder;
  write_all(folder.path(), random_packets(100));
  std::string bytes = test::slurp(folder / "lidar.pcap");
  const std::size_t length_of_first_record = 24 + 8;
  bytes[length_of_first_record + 3] = '\x7F';
  test::spit(folder / "lidar.pcap", bytes);
  const auto replayed = read_all(folder.path());
  ASSERT_EQ(replayed.errors.size(), 1U);
  EXPECT_THAT(replayed.errors[0], ::testing::AllOf(HasSubstr("lidar.pcap"), HasSubstr("offset")));
  EXPECT_GT(replayed.packets.size(), 30U);
}

TEST(RecordingFolder, ADamagedListOfSweepsGivesThoseBefore) {
  const TemporaryFolder folder;
  write_all(folder.path(), random_packets(100));
  const std::string csv = test::slurp(folder / "data.csv");
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  test::spit(folder / "data.csv", csv + "garbage\n");
  const auto replayed = read_all(folder.path());
  ASSERT_EQ(replayed.errors.size(), 1U);
  EXPECT_THAT(replayed.errors[0],
              ::testing::AllOf(HasSubstr("data.csv"), HasSubstr("line " + std::to_string(lines + 1))));
  EXPECT_EQ(replayed.packets.size(), 100U);
}

TEST(RecordingFolder, ASweepThatIsNotThereIsOneErrorAndTheNextComes) {
  const TemporaryFolder folder;
  write_all(folder.path(), random_packets(100));
  fs::remove(folder / "scans/000002.bin");
  fs::resize_file(folder / "scans/000003.bin", 50'000'000);
  const auto replayed = read_all(folder.path());
  ASSERT_EQ(replayed.errors.size(), 2U);
  EXPECT_THAT(replayed.errors[0], HasSubstr("000002.bin"));
  EXPECT_THAT(replayed.errors[1], HasSubstr("too large"));
  EXPECT_EQ(replayed.packets.size(), 98U);
}

TEST(RecordingFolder, AWrongOffsetIsSaidForEachPacket) {
  const TemporaryFolder folder;
  write_all(folder.path(), random_packets(50));
  std::string index = test::slurp(folder / "recording.yaml");
  index.replace(index.find(std::to_string(kOffset)), 19, "-2000000000000000000");
  test::spit(folder / "recording.yaml", index);
  const auto replayed = read_all(folder.path());
  EXPECT_GT(replayed.errors.size(), 20U);
  EXPECT_THAT(replayed.errors[0], HasSubstr("realtime_offset_ns"));
}

TEST(RecordingFolder, NextKeepsTheMemoryOfItsPackets) {
  const TemporaryFolder folder;
  std::vector<Packet> packets(1000);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    packets[i].arrival = Time(Duration(i));
    packets[i].channel = 2368;
    packets[i].bytes.resize(1206);
  }
  write_all(folder.path(), packets);
  auto reader = RecordingReader::open(folder.path());
  Packet packet;
  std::vector<const std::byte*> places;
  while (*(*reader)->next(packet, {}) == Poll::kPacket) places.push_back(packet.bytes.data());
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  EXPECT_LE(places.size(), 4U + StampGuard::kAhead);
}

}  // namespace
}  // namespace cairn::recording
