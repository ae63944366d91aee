// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/doctor_command.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "tests/support/sample_view.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/doctor/peer.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome doctor(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "doctor");
  return run(add_doctor_command, std::move(arguments));
}

void put(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text << '\n';
}

void put_can(const fs::path& root, const std::string& name, const std::string& state, int queue) {
  const fs::path folder = root / "sys/class/net" / name;
  put(folder / "type", "280");
  put(folder / "operstate", state);
  put(folder / "tx_queue_len", std::to_string(queue));
}

TEST(DoctorCommand, AnEmptyComputerHasNothingPluggedIn) {
  const TemporaryFolder folder;
  const Outcome o = doctor({"--root", folder / ""});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_THAT(o.out, HasSubstr("ok: cameras: none plugged in"));
  EXPECT_THAT(o.out, HasSubstr("ok: CAN: no interface"));
  EXPECT_THAT(o.out, HasSubstr("ok: GPIO: no chip"));
  EXPECT_THAT(o.out, HasSubstr("PREEMPT_RT"));
}

TEST(DoctorCommand, EveryFaultHasItsRemedy) {
  const TemporaryFolder folder;
  const fs::path root = folder / "";
  put_can(root, "can0", "down", 10);
  put_can(root, "can1", "up", 1000);
  put_can(root, "can2", "up", 16);
  put(root / "sys/class/net/eth0/type", "1");
  put(root / "sys/class/video4linux/video3/name", "PureThermal (fw:v1.3.0)");
  put(root / "sys/class/video4linux/video4/index", "1");
  put(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  put(root / "proc/sys/net/core/rmem_max", "212992");
  const Outcome o = doctor({"--root", root.string()});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("problem: can0: CAN interface, down → sudo ip link set can0 type can bitrate 500000"));
  EXPECT_THAT(o.out, HasSubstr("note: can1"));
  EXPECT_THAT(o.out, HasSubstr("sudo ip link set can1 txqueuelen 16"));
  EXPECT_THAT(o.out, HasSubstr("ok: can2: CAN interface, up"));
  EXPECT_THAT(o.out, Not(HasSubstr("eth0")));
  EXPECT_THAT(o.out,
              HasSubstr("problem: /dev/video3: PureThermal (fw:v1.3.0), which this user may not open → sudo cp"));
  EXPECT_THAT(o.out, Not(HasSubstr("video4")));
  EXPECT_THAT(o.out, HasSubstr("cpupower frequency-set -g performance"));
  EXPECT_THAT(o.out, HasSubstr("net.core.rmem_max=4194304"));
}

TEST(DoctorCommand, DevicesOfAProfileAreOpenedAndListenedTo) {
  const TemporaryFolder folder;
  put(folder / "robot.yaml",
      "lidar: {enabled: false}\ncamera: {capture: {device: /dev/nothing}}\ndrive: {interface: nocan7}");
  const Outcome o = doctor({"--config", folder / "robot.yaml", "--root", folder / "", "--seconds", "0.01", "--json"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  const auto json = o.json();
  EXPECT_EQ(json["problems"], 2);
  EXPECT_EQ(json["findings"][0]["level"], "ok");
  EXPECT_THAT(json["findings"][1]["what"].get<std::string>(), HasSubstr("camera: /dev/nothing"));
  EXPECT_THAT(json["findings"][2]["what"].get<std::string>(), HasSubstr("drive: "));
  for (const std::size_t i : {1U, 2U}) EXPECT_NE(json["findings"][i]["remedy"], "");
}

TEST(DoctorCommand, AScheduleThatARunRefusesIsNotInOrder) {
  const TemporaryFolder folder;
  for (const char* schedule :
       {"odometry: {busy_hz: 100}", "odometry: {soft_ms: 60, hard_ms: 50}", "rejoin: {core: 99}"}) {
    put(folder / "robot.yaml", "lidar: {bind_address: 127.88.0.1}\nschedule: {" + std::string(schedule) + "}");
    const Outcome o = doctor({"--config", folder / "robot.yaml", "--root", folder / "", "--seconds", "0.01"});
    EXPECT_EQ(o.exit_code, app::kFailed) << schedule;
    EXPECT_THAT(o.out, HasSubstr("problem: profile: schedule: the schedule does not fit this machine")) << schedule;
    EXPECT_THAT(o.out, Not(HasSubstr("is in order"))) << schedule;
  }
}

TEST(DoctorCommand, AProfileThatWouldNotRunIsNoted) {
  const TemporaryFolder folder;
  put(folder / "robot.yaml", "lidar: {enabled: false}\ndrive: {interface: nocan7}");
  const Outcome o = doctor({"--config", folder / "robot.yaml", "--root", folder / "", "--seconds", "0.01"});
  EXPECT_THAT(o.out, HasSubstr("note: profile: cairn run would not start: this robot has neither a LiDAR nor"));
}

TEST(DoctorCommand, AFaultyProfileIsAProblemWithItsLine) {
  const TemporaryFolder folder;
  put(folder / "robot.yaml", "camera: {captuer: 1}");
  const Outcome o = doctor({"--config", folder / "robot.yaml", "--root", folder / ""});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("robot.yaml:1: camera.captuer"));
}

TEST(DoctorCommand, DamageOfARecordingIsNamed) {
  const TemporaryFolder folder;
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"sweeps", recording::kScans, "data.csv", "base_link", ""},
               {"gpio", recording::kGpio, "gpio.csv", "base_link", ""},
               {"drive", recording::kDrive, "drive.log", "base_link", "cia402"}};
  auto writer = recording::RecordingWriter::create(folder / "r", r).value();
  Packet p;
  PointCloud cloud;
  cloud.push_back({1, 2, 3}, 10, 0, 0, ReturnType::kStrongest);
  p.bytes = recording::encode_scan(cloud, true);
  p.channel = 1;
  ASSERT_TRUE(writer.write(p));
  ASSERT_TRUE(writer.close());
  std::ofstream(folder / "r/gpio.csv", std::ios::app) << "nonsense\n";
  const Outcome o = doctor({"--recording", folder / "r"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("ok: sweeps: 1 packets, none lost"));
  EXPECT_THAT(o.out, HasSubstr("problem: drive: the recording holds nothing of it"));
  EXPECT_THAT(o.out, HasSubstr("gpio.csv"));
  EXPECT_EQ(doctor({"--recording", folder / "nowhere"}).exit_code, app::kFailed);
}

TEST(DoctorCommand, AnUnfinishedRecordingIsAProblemWithARemedy) {
  const TemporaryFolder folder;
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"gpio", recording::kGpio, "gpio.csv", "base_link", ""}};
  auto writer = recording::RecordingWriter::create(folder / "r", r).value();
  ASSERT_TRUE(writer.flush());
  const Outcome o = doctor({"--recording", folder / "r"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("the recording was not closed"));
  EXPECT_THAT(o.out, HasSubstr("→ its last second may be missing"));
  EXPECT_EQ(o.out.find("was not closed"), o.out.rfind("was not closed")) << "said once";
  ASSERT_TRUE(writer.close());
  EXPECT_EQ(doctor({"--recording", folder / "r"}).exit_code, app::kDone);
}

TEST(DoctorCommand, SaysWhyAPeerHasNotMergedByWhatARunLeft) {
  const TemporaryFolder folder;
  put(folder / "report.json", R"json({"peers": {
    "robot_2": {"accepted": true, "state": "merged", "reason": "merged", "tiles": 12},
    "robot_3": {"accepted": false, "state": "ambiguous", "reason": "another pose may be as good (overlap 0.86, 9 m²)", "tiles": 7},
    "robot_4": 5}})json");
  const Outcome all = doctor({"--peer", "all", "--run", folder / ""});
  EXPECT_EQ(all.exit_code, app::kFailed);
  EXPECT_THAT(all.out, HasSubstr("ok: robot_2: merged (12 tiles)"));
  EXPECT_THAT(
      all.out,
      HasSubstr(
          "problem: robot_3 is not merged: another pose may be as good (overlap 0.86, 9 m²) (7 tiles) → ambiguous"));
  EXPECT_EQ(doctor({"--peer", "robot_2", "--run", folder / ""}).exit_code, app::kDone);
  EXPECT_THAT(doctor({"--peer", "robot_9", "--run", folder / ""}).out,
              HasSubstr("robot_9: no robot of this name was heard; heard: robot_2, robot_3 → start"));
}

TEST(DoctorCommand, OfARunWithoutATeamItSaysThat) {
  const TemporaryFolder folder;
  put(folder / "report.json", R"({"peers": {}, "team": null})");
  EXPECT_THAT(doctor({"--peer", "all", "--run", folder / ""}).out, HasSubstr("took no part in a team: start the core"));
  put(folder / "report.json", R"({"peers": {}, "team": {"id": 1}})");
  EXPECT_THAT(doctor({"--peer", "all", "--run", folder / ""}).out, HasSubstr("no robot of the team was heard → start"));
}

TEST(DoctorCommand, OfAFolderOfRunsItNamesThem) {
  const TemporaryFolder folder;
  for (const char* name : {"robot_2", "robot_1"}) {
    std::filesystem::create_directory(folder / name);
    put(folder / (std::string(name) + "/report.json"), "{}");
  }
  EXPECT_THAT(doctor({"--peer", "all", "--run", folder / ""}).out,
              HasSubstr("this folder is no run: it holds robot_1, robot_2"));
}

TEST(DoctorCommand, ADeploymentThatTheMapsContradictIsNamed) {
  const TemporaryFolder folder;
  put(folder / "report.json", R"json({"peers": {
    "robot_2": {"accepted": true, "state": "merged", "deployment_contradicted": true,
                "reason": "merged; the deployments of the two contradict that by 3.6 m", "tiles": 12},
    "robot_3": {"accepted": false, "state": "contradicted", "deployment_contradicted": true,
                "reason": "dropped; the maps contradict the deployments of the two"}}})json");
  const Outcome merged = doctor({"--peer", "robot_2", "--run", folder / ""});
  EXPECT_EQ(merged.exit_code, app::kDone);
  EXPECT_THAT(merged.out, HasSubstr("note: robot_2: merged; the deployments of the two contradict that by 3.6 m"));
  EXPECT_THAT(merged.out, HasSubstr("team.deployment"));
  EXPECT_THAT(doctor({"--peer", "robot_3", "--run", folder / ""}).out, HasSubstr("→ correct team.deployment"));
}

TEST(DoctorCommand, SaysWhereThereIsNothingToBeHeardOfAPeer) {
  const TemporaryFolder folder;
  EXPECT_THAT(doctor({"--peer", "x", "--live-view", folder / "no.sock"}).out, HasSubstr("no.sock"));
  EXPECT_THAT(doctor({"--peer", "x", "--run", folder / "none"}).out, HasSubstr("report.json"));
  put(folder / "report.json", "[1, 2");
  EXPECT_THAT(doctor({"--peer", "x", "--run", folder / ""}).out, HasSubstr("not the report of a run"));
  EXPECT_THAT(doctor({"--peer", "x", "--recording", folder / "none"}).out, HasSubstr("problem"));
}

TEST(DoctorCommand, EveryStateOfAPeerHasARemedyButTheGoodOne) {
  for (std::size_t i = 0; i < team::kPeerStates; ++i) {
    const auto state = static_cast<team::PeerState>(i);
    app::LiveView::Peer peer;
    peer.name = "robot_2";
    peer.merged = state == team::PeerState::kMerged;
    peer.state = to_string(state);
    const auto findings = judge_peers({peer}, "robot_2");
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].remedy, remedy_for(state, "robot_2")) << peer.state;
    EXPECT_EQ(findings[0].remedy.empty(), peer.merged) << peer.state;
    EXPECT_EQ(findings[0].level, peer.merged ? Finding::Level::kOk : Finding::Level::kProblem) << peer.state;
  }
}

TEST(DoctorCommand, AStateOfALaterVersionHasTheGeneralRemedy) {
  const auto findings = judge_peers({{.name = "robot_2", .state = "dancing", .reason = "it dances"}}, "all");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].remedy, remedy_for(team::PeerState::kUndecided, "robot_2"));
}

TEST(DoctorCommand, AClockThatDiffersIsANote) {
  const auto findings = judge_peers(support::sample_view().peers, "robot_3");
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_THAT(findings[0].remedy, HasSubstr("radio"));
  EXPECT_THAT(findings[1].what, HasSubstr("clock differs by -7.5 s"));
}

TEST(DoctorCommand, OptionsThatWouldBeIgnoredAreRefused) {
  const TemporaryFolder folder;
  for (const char* option : {"--run", "--live-view"}) {
    const Outcome o = doctor({option, folder / "none"});
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(o.err, HasSubstr(std::string(option) + " requires --peer"));
  }
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--config", folder / "robot.yaml"}, {"--seconds", "2"}, {"--root", folder / ""}}) {
    const Outcome o = doctor({"--peer", "all", "--run", folder / "", option[0], option[1]});
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << option[0];
    EXPECT_THAT(o.err, HasSubstr(option[0]));
  }
}

}  // namespace
}  // namespace cairn::cli
