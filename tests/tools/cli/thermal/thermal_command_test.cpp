// SPDX-License-Identifier: Apache-2.0
// `cairn thermal` on a simulated recording, and beside a core.
#include "tools/cli/thermal/thermal_command.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <memory>

#include "drivers/recording/formats/pcd_file.hpp"
#include "hal/files/file.hpp"
#include "tests/drivers/camera/frames.hpp"
#include "tests/tools/cli/stream/core_stand_in.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ThermalCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    simulator::SimulationConfig config;
    config.scene = "corridor";
    config.seconds = 1;
    config.seed = 70002;
    config.people.count = 4;
    config.sensors.thermal = true;
    config.out = *made_ / "sim";
    const auto robots = simulator::simulate(config);
    ASSERT_TRUE(robots) << to_string(robots.error());
  }
  static void TearDownTestSuite() { made_.reset(); }

  static fs::path recording() { return *made_ / "sim/robot_1"; }
  Outcome thermal(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"thermal", "--out", cloud().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_thermal_command, std::move(arguments));
  }
  fs::path cloud() const { return folder_ / "cloud.pcd"; }

  static inline std::unique_ptr<TemporaryFolder> made_;
  TemporaryFolder folder_;
};

TEST_F(ThermalCommand, MakesACloudOfARecording) {
  const Outcome o = thermal({recording().string(), "--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_GT(o.json()["pictures"], 5);
  EXPECT_EQ(o.json()["unit"], "celsius");
  EXPECT_GT(o.json()["lowest"], 0);
  EXPECT_GT(o.json()["highest"], 25) << "somebody";
  const auto header = recording::parse_pcd_header(read_file(cloud(), recording::kMaxPcdBytes).value(), "cloud.pcd");
  ASSERT_TRUE(header) << to_string(header.error());
  EXPECT_EQ(header->points, o.json()["points"]);
  EXPECT_NE(header->field("temperature"), nullptr);
}

TEST_F(ThermalCommand, LargerVoxelsAreFewer) {
  const Outcome fine = thermal({recording().string(), "--json"});
  const Outcome coarse = thermal({recording().string(), "--json", "--voxel", "0.5"});
  EXPECT_GT(fine.json()["points"].get<int>(), 2 * coarse.json()["points"].get<int>());
}

TEST_F(ThermalCommand, SaysWhatIsMissing) {
  fs::create_directories(folder_ / "lidar");
  for (const char* name : {"recording.yaml", "lidar.pcap", "profile.yaml"})
    fs::copy_file(recording() / name, folder_ / "lidar" / name);
  Outcome o = thermal({(folder_ / "lidar").string()});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_FALSE(fs::exists(cloud()));
  o = thermal({recording().string(), "--config", "/nowhere.yaml"});
  EXPECT_THAT(o.err, HasSubstr("/nowhere.yaml"));
  o = run(add_thermal_command, {"thermal", recording().string(), "--out", (folder_ / "cloud.ply").string()});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("must end in .pcd"));
}

TEST_F(ThermalCommand, ACameraThatIsNotCalibratedIsNamed) {
  const auto text = read_file(recording() / "profile.yaml", 1U << 20U).value();
  std::string profile(reinterpret_cast<const char*>(text.data()), text.size());
  const std::size_t intrinsics = profile.find("intrinsics:", profile.find("\nthermal:"));
  for (const std::string key : {"fx: ", "fy: ", "cx: ", "cy: "}) {
    const std::size_t at = profile.find(key, intrinsics);
    profile.replace(at, profile.find('\n', at) - at, key + "0");
  }
  ASSERT_TRUE(write_file_atomic(folder_ / "robot.yaml", std::as_bytes(std::span(profile))));
  const Outcome o = thermal({recording().string(), "--config", (folder_ / "robot.yaml").string()});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("thermal.intrinsics of the profile are not set"));
}

/// A core whose thermal camera sees 32 °C everywhere.
class CoreWithThermal {
 public:
  void prepare(app::StreamsTask& task) {
    thermal::Config config;
    config.model = "plain";
    config.units = "centikelvin";
    const auto lens = cameras::CameraModel::create(
        {.width = 64, .height = 48, .fx = 40, .fy = 40, .cx = 31.5, .cy = 23.5, .distortion = {}});
    task.show(std::make_unique<app::ThermalStream>(thermal::Thermal::create(config).value(),
                                                   labelling::ThermalLifter(*lens, SE3(), {}), monitor_),
              {});
  }
  static void see(app::StreamOutlets& outlets, int tick) {
    if (!outlets.thermal.wanted) return;
    LocatedScan* scan = outlets.scans.back();
    Packet* picture = outlets.thermal.pictures.back();
    if (scan == nullptr || picture == nullptr) return;
    *scan = {};
    scan->stamp = Time{std::chrono::milliseconds(100 * tick)};
    scan->points_base = {{5, 0, 0}};
    outlets.scans.push();
    *picture = warm(tick);
    picture->arrival = scan->stamp;
    outlets.thermal.pictures.push();
  }

 private:
  static Packet warm(int tick) {
    const std::uint16_t count = 30'515;
    std::vector<std::byte> payload(std::size_t{64} * 48 * 2);
    for (std::size_t i = 0; i < payload.size(); i += 2) std::memcpy(&payload[i], &count, 2);
    return camera::test::packet_of(camera::test::header_of(camera::FrameFormat::kY16, 64, 48, 128), payload,
                                   static_cast<std::uint64_t>(tick));
  }
  Monitor monitor_;
};

TEST_F(ThermalCommand, GathersWhatACoreSends) {
  CoreWithThermal core;
  const Outcome o =
      test::run_beside_core(add_thermal_command, {"thermal", "--pictures", "3", "--json", "--out", cloud().string()},
                            CoreWithThermal::see, [&](app::StreamsTask& task) { core.prepare(task); });
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_EQ(o.json()["pictures"], 3);
  EXPECT_EQ(o.json()["points"], 1);
  EXPECT_NEAR(o.json()["highest"], 32, 1e-3);
}

TEST_F(ThermalCommand, OfACoreWithoutACameraItSaysWhyNothingComes) {
  const Outcome o = test::run_beside_core(
      add_thermal_command, {"thermal", "--seconds", "0.1", "--out", cloud().string()}, [](app::StreamOutlets&, int) {});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no picture of the thermal camera met a scan"));
}

}  // namespace
}  // namespace cairn::cli
