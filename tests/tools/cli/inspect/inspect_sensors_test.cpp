// SPDX-License-Identifier: Apache-2.0
// `cairn inspect` over cameras, CAN buses and GPIO lines: whole recordings and their files on their own.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include "drivers/camera/frame.hpp"
#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/messages/command.hpp"
#include "drivers/peers/peer_packet.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "fusion/peers/datagrams/datagram.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"

namespace cairn::cli {
namespace {

Outcome look_into(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "inspect");
  return run(add_inspect_command, std::move(arguments));
}

Packet frame_of(std::size_t source, camera::FrameFormat format, int n, std::uint16_t value) {
  Packet p;
  p.source = static_cast<SourceId>(source);
  p.sequence = static_cast<std::uint64_t>(n);
  p.arrival = Time(std::chrono::milliseconds(100 * n));
  camera::append_header(p.bytes, {static_cast<std::uint32_t>(format), 160, 120, 320, false});
  for (int i = 0; i < 160 * 120; ++i) {
    p.bytes.push_back(static_cast<std::byte>(value & 0xFFU));
    p.bytes.push_back(static_cast<std::byte>(value >> 8U));
  }
  return p;
}

/// Ten thermal and ten depth pictures: 300 K, two metres.
void write_pictures(const std::string& dir) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"thermal", recording::kThermal, "thermal/data.csv", "thermal", "lepton3"},
               {"depth", recording::kDepth, "depth/data.csv", "depth", ""}};
  auto writer = recording::RecordingWriter::create(dir, r).value();
  for (int n = 0; n < 10; ++n) {
    ASSERT_TRUE(writer.write(frame_of(0, camera::FrameFormat::kY16, n, 30'000)));
    ASSERT_TRUE(writer.write(frame_of(1, camera::FrameFormat::kZ16, n, 2000)));
  }
  ASSERT_TRUE(writer.close());
}

TEST(InspectSensors, PicturesOfARecording) {
  const TemporaryFolder folder;
  write_pictures(folder / "r");
  const auto json = look_into({folder / "r", "--json"}).json();
  EXPECT_EQ(json["damaged"], 0);
  EXPECT_EQ(json["sources"][0]["thermal"]["pictures"], 10);
  EXPECT_EQ(json["sources"][0]["thermal"]["sizes"][0], "160x120");
  EXPECT_EQ(json["sources"][1]["depth"]["pictures"], 10);
  EXPECT_EQ(json["sources"][1]["scans"]["count"], 10);
  EXPECT_EQ(look_into({folder / "r", "--json"}).json(), json) << "the same bytes give the same pictures";
}

TEST(InspectSensors, AListOfPicturesOnItsOwn) {
  const TemporaryFolder folder;
  write_pictures(folder / "r");
  const auto thermal = look_into({folder / "r/thermal/data.csv", "--json"}).json();
  EXPECT_EQ(thermal["kind"], "thermal");
  EXPECT_EQ(thermal["sources"][0]["thermal"]["pictures"], 10);
  EXPECT_EQ(look_into({folder / "r/depth/data.csv", "--json"}).json()["sources"][0]["depth"]["pictures"], 10);
}

/// An array as numpy.save() writes it; pixels of two bytes that all hold `value`.
void write_array(const std::string& path, const std::string& type, int frames, int height, int width, char value) {
  const std::string shape = fmt::format("({}, {}, {})", frames, height, width);
  const std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::ofstream file(path, std::ios::binary);
  file << "\x93NUMPY\x01" << '\0' << static_cast<char>(header.size()) << '\0' << header;
  file << std::string(static_cast<std::size_t>(frames * height * width) * (type == "<u2" ? 2 : 1), value);
}

TEST(InspectSensors, AnArrayOfPicturesIsToldByItsPixelsAndItsName) {
  const TemporaryFolder folder;
  write_array(folder / "a.npy", "<u2", 5, 120, 160, '\x60');
  const auto lepton = look_into({folder / "a.npy", "--json"}).json();
  EXPECT_EQ(lepton["kind"], "thermal");
  EXPECT_EQ(lepton["assumed_rate_hz"], 9.0);
  EXPECT_EQ(lepton["sources"][0]["model"], "lepton3");
  EXPECT_EQ(lepton["sources"][0]["thermal"]["pictures"], 5);
  EXPECT_EQ(lepton["damaged"], 0);

  write_array(folder / "b.npy", "<u2", 2, 48, 64, '\x60');
  EXPECT_EQ(look_into({folder / "b.npy", "--json"}).json()["sources"][0]["thermal"]["sizes"][0], "64x48");
  write_array(folder / "depth.npy", "<u2", 3, 48, 64, '\x05');
  EXPECT_EQ(look_into({folder / "depth.npy", "--json"}).json()["sources"][0]["depth"]["pictures"], 3);
  write_array(folder / "grey.npy", "|u1", 4, 48, 64, '\x05');
  EXPECT_EQ(look_into({folder / "grey.npy", "--json"}).json()["sources"][0]["camera"]["pictures"], 4);
}

TEST(InspectSensors, AnArrayThatEndsEarlyIsDamagedAndADamagedHeaderAnError) {
  const TemporaryFolder folder;
  write_array(folder / "a.npy", "<u2", 5, 120, 160, '\x60');
  std::filesystem::resize_file(folder / "a.npy", std::filesystem::file_size(folder / "a.npy") - 1);
  const auto json = look_into({folder / "a.npy", "--json"}).json();
  EXPECT_EQ(json["sources"][0]["thermal"]["pictures"], 4);
  EXPECT_EQ(json["damaged"], 1);
  write_array(folder / "b.npy", ">u2", 1, 4, 4, 'x');
  EXPECT_EQ(look_into({folder / "b.npy", "--json"}).json()["kind"], "array") << "pixels of no camera";
  std::filesystem::resize_file(folder / "b.npy", 20);
  EXPECT_EQ(look_into({folder / "b.npy"}).exit_code, app::kFailed);
}

TEST(InspectSensors, ARealArrayOfTemperatures) {
  const auto path = support::recorded_data("thermal/lepton3_possum_161x120x160_u16.npy");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const auto json = look_into({path.string(), "--json"}).json();
  EXPECT_EQ(json["sources"][0]["thermal"]["pictures"], 161);
  EXPECT_EQ(json["damaged"], 0);
}

TEST(InspectSensors, AMissingPictureIsDamageAndNotAnEnd) {
  const TemporaryFolder folder;
  write_pictures(folder / "r");
  std::filesystem::remove(folder / "r/thermal/data/300000000.png");
  const auto json = look_into({folder / "r", "--json"}).json();
  EXPECT_EQ(json["damaged"], 1);
  EXPECT_EQ(json["sources"][0]["thermal"]["pictures"], 9);
  EXPECT_EQ(json["sources"][1]["depth"]["pictures"], 10);
}

TEST(InspectSensors, ACanBus) {
  const TemporaryFolder folder;
  std::ofstream(folder / "drive.log") << "(1.000000) can0 211#0100010100000001\n(1.100000) can0 181#2706\n"
                                         "(1.200000) can0 181#3706\n(1.300000) can0 20000004#0004000000000000\n";
  const auto can = look_into({folder / "drive.log", "--json"}).json()["sources"][0]["drive"];
  EXPECT_EQ(can["frames"], 4);
  EXPECT_EQ(can["error_frames"], 1);
  EXPECT_EQ(can["ids"]["181"]["frames"], 2);
  EXPECT_EQ(can["ids"]["181"]["last"], "3706");
  EXPECT_EQ(can["agilex"]["vehicle"], "emergency stop");
  EXPECT_DOUBLE_EQ(can["agilex"]["battery_v"], 25.7);
}

TEST(InspectSensors, GpioLines) {
  const TemporaryFolder folder;
  std::ofstream(folder / "gpio.csv") << "stamp_ns,line,level\n100,estop,1\n200,estop,0\nnonsense\n300,trigger,1\n";
  const auto json = look_into({folder / "gpio.csv", "--json"}).json();
  EXPECT_EQ(json["kind"], "gpio");
  EXPECT_EQ(json["damaged"], 1);
  EXPECT_EQ(json["sources"][0]["gpio"]["estop"]["falling"], 1);
  EXPECT_EQ(json["sources"][0]["gpio"]["estop"]["last_level"], 0);
  EXPECT_EQ(json["sources"][0]["gpio"]["trigger"]["rising"], 1);
}

TEST(InspectSensors, AnUnknownModelNamesTheKnownOnes) {
  const TemporaryFolder folder;
  write_pictures(folder / "r");
  const Outcome o = look_into({folder / "r/thermal/data.csv", "--model", "lepton9"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, ::testing::HasSubstr("lepton9"));
}

TEST(InspectSensors, WhatPeersSaidIsCountedByWhoSaidIt) {
  const TemporaryFolder folder;
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"peers", recording::kPeers, "peers.log", "", ""}};
  auto writer = recording::RecordingWriter::create(folder / "rec", r).value();
  Packet packet;
  peer_link::encode(peer_link::Beginning{1, 5}, packet);
  ASSERT_TRUE(writer.write(packet));
  packet.channel = 0;
  packet.bytes = peers::encode({3, peers::Hello{7, 0, Time{}, "third", {}}, {}, {}}).bytes;
  ASSERT_TRUE(writer.write(packet));
  packet.bytes.assign(30, std::byte{9});
  ASSERT_TRUE(writer.write(packet));
  ASSERT_TRUE(writer.close());
  const Outcome o = look_into({folder / "rec", "--json"});
  const auto figures = nlohmann::json::parse(o.out)["sources"][0]["peers"];
  EXPECT_EQ(figures["robot"], 1);
  EXPECT_EQ(figures["rejected"], 1);
  EXPECT_EQ(figures["peers"]["3"]["name"], "third");
  EXPECT_EQ(figures["peers"]["3"]["hellos"], 1);
}

TEST(InspectSensors, WhatClientsCommandedIsCountedByVerb) {
  const TemporaryFolder folder;
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"commands", recording::kCommands, "commands.log", "", ""}};
  auto writer = recording::RecordingWriter::create(folder / "rec", r).value();
  Packet packet;
  packet.bytes = {clients::kClientJoined};
  ASSERT_TRUE(writer.write(packet));
  for (std::uint32_t number = 1; number < 4; ++number) {
    encode(clients::Command{.verb = clients::Command::Verb::kVelocity,
                            .number = number,
                            .v = -0.1 * number,
                            .who = clients::ClientName("desk")},
           packet.bytes);
    ASSERT_TRUE(writer.write(packet));
  }
  packet.bytes = {clients::kClientLeft};
  ASSERT_TRUE(writer.write(packet));
  ASSERT_TRUE(writer.close());
  const Outcome o = look_into({folder / "rec", "--json"});
  const auto figures = nlohmann::json::parse(o.out)["sources"][0]["commands"];
  EXPECT_EQ(figures["connections"], 1);
  EXPECT_EQ(figures["commands"]["velocity"], 3);
  EXPECT_EQ(figures["clients"], nlohmann::json::array({"desk"}));
  EXPECT_NEAR(figures["fastest_m_s"].get<double>(), 0.3, 1e-9);
}

}  // namespace
}  // namespace cairn::cli
