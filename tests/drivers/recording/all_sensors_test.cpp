// SPDX-License-Identifier: Apache-2.0
// A recording with every kind of sensor: what the writer is given, the reader hands out.
#include <gmock/gmock.h>

#include <algorithm>

#include "drivers/camera/frame.hpp"
#include "drivers/drive/can/can_frame.hpp"
#include "drivers/gpio/line_event.hpp"
#include "drivers/recording/new_recording.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using camera::FrameFormat;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr std::int64_t kUtcOffset = 1'700'000'000'000'000'000;

Recording every_sensor() {
  Recording r;
  r.robot = "husky";
  r.start_utc_ns = r.realtime_offset_ns = kUtcOffset;
  r.sources = {{"camera", kCamera, "camera/data.csv", "camera", ""},
               {"thermal", kThermal, "thermal/data.csv", "thermal", "lepton3"},
               {"depth", kDepth, "depth/data.csv", "depth", ""},
               {"drive", kDrive, "drive.log", "base_link", "cia402"},
               {"gpio", kGpio, "gpio.csv", "base_link", ""}};
  return r;
}

Packet stamped(std::size_t source, std::int64_t microseconds, std::uint64_t sequence) {
  Packet p;
  p.source = static_cast<SourceId>(source);
  p.arrival = Time(std::chrono::microseconds(microseconds));
  p.sequence = sequence;
  return p;
}

Packet picture(std::size_t source, FrameFormat format, std::uint64_t n) {
  Packet p = stamped(source, static_cast<std::int64_t>(1000 * n + source), n);
  const std::uint32_t bytes = format == FrameFormat::kGrey ? 1 : 2;
  camera::append_header(p.bytes, {static_cast<std::uint32_t>(format), 8, 4, 8 * bytes, false});
  for (std::uint32_t i = 0; i < 32 * bytes; ++i) p.bytes.push_back(static_cast<std::byte>(i * 7 + n));
  return p;
}

/// 20 rounds: a picture of each camera, a frame received and one sent, an edge.
std::vector<Packet> packets_of_every_sensor() {
  std::vector<Packet> packets;
  for (std::uint64_t n = 0; n < 20; ++n) {
    packets.push_back(picture(0, FrameFormat::kGrey, n));
    packets.push_back(picture(1, FrameFormat::kY16, n));
    packets.push_back(picture(2, FrameFormat::kZ16, n));
    for (const auto direction : {drive::Direction::kReceived, drive::Direction::kSent}) {
      const auto sent = static_cast<std::uint16_t>(direction);
      packets.push_back(stamped(3, static_cast<std::int64_t>(1000 * n + 3 + sent), 2 * n + sent));
      encode_frame(drive::make_frame(0x181, {static_cast<std::uint8_t>(n), 2, 3}), packets.back());
      packets.back().channel = sent;
    }
    packets.push_back(stamped(4, static_cast<std::int64_t>(1000 * n + 8), n));
    // The kernel's count of edges is not in gpio.csv; replay counts anew.
    gpio::encode_event({gpio::Line::kEStop, n % 2 == 0, false, static_cast<std::uint32_t>(n + 1)}, packets.back());
  }
  return packets;
}

void write_all(const fs::path& dir, const std::vector<Packet>& packets) {
  auto writer = RecordingWriter::create(dir, every_sensor());
  ASSERT_TRUE(writer) << to_string(writer.error());
  for (const Packet& p : packets) {
    const auto written = writer->write(p);
    ASSERT_TRUE(written) << to_string(written.error());
  }
  ASSERT_TRUE(writer->flush());
  ASSERT_TRUE(writer->close());
}

TEST(AllSensors, AReplayHandsOutWhatWasRecorded) {
  const TemporaryFolder folder;
  const auto packets = packets_of_every_sensor();
  write_all(folder / "r", packets);
  auto reader = RecordingReader::open(folder / "r").value();
  Packet p;
  for (const Packet& wanted : packets) {
    ASSERT_EQ(reader->next(p, {}).value(), Poll::kPacket);
    EXPECT_EQ(p.source, wanted.source);
    EXPECT_EQ(p.arrival, wanted.arrival);
    EXPECT_EQ(p.channel, wanted.channel);
    EXPECT_EQ(p.sequence, wanted.sequence);
    if (wanted.source != SourceId{4})
      EXPECT_EQ(p.bytes, wanted.bytes);
    else
      EXPECT_EQ(gpio::decode_event(p)->level, gpio::decode_event(wanted)->level);
  }
  EXPECT_EQ(reader->next(p, {}).value(), Poll::kEnd);
}

TEST(AllSensors, OverwritingLeavesNoOldPictures) {
  const TemporaryFolder folder;
  const auto packets = packets_of_every_sensor();
  write_all(folder / "r", packets);
  auto again = NewRecording::begin(folder / "r", Overwrite::kYes).value();
  write_all(again.folder(), {packets.begin(), packets.begin() + 3});
  ASSERT_TRUE(again.finish());
  const auto pictures = fs::directory_iterator(folder / "r" / "camera" / "data");
  EXPECT_EQ(std::distance(begin(pictures), end(pictures)), 1);
}

TEST(AllSensors, WhatDoesNotFitItsKindIsRefusedAndTheRestGoesOn) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "r", every_sensor()).value();
  for (std::size_t source = 0; source < 5; ++source) {
    Packet odd = stamped(source, 5, 0);
    odd.bytes.resize(3);
    EXPECT_FALSE(writer.write(odd)) << source;
  }
  EXPECT_TRUE(writer.write(picture(1, FrameFormat::kY16, 1)));
  EXPECT_EQ(writer.packets(), 1U);
  EXPECT_TRUE(writer.close());
}

TEST(AllSensors, AMissingPictureIsOneErrorAndTheOthersFollow) {
  const TemporaryFolder folder;
  write_all(folder / "r", packets_of_every_sensor());
  fs::remove(folder / "r" / "thermal" / "data" / "4001000.png");
  auto reader = RecordingReader::open(folder / "r").value();
  Packet p;
  int packets = 0;
  std::string error;
  for (auto poll = reader->next(p, {}); !poll || *poll != Poll::kEnd; poll = reader->next(p, {})) {
    packets += poll ? 1 : 0;
    if (!poll) error += to_string(poll.error());
  }
  EXPECT_EQ(packets, 119);
  EXPECT_THAT(error, HasSubstr("4001000.png"));
}

}  // namespace
}  // namespace cairn::recording
