// SPDX-License-Identifier: Apache-2.0
// `cairn evaluate people` and `cairn evaluate map --recording` on a simulated recording with people.
#include <gmock/gmock.h>

#include <filesystem>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/evaluate/mover_error.hpp"
#include "tools/cli/evaluate/path.hpp"
#include "tools/cli/evaluate/people_scene.hpp"
#include "tools/cli/map/evaluate_command.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// odom in the world.
const SE3 kOdom = SE3::from_xyz_rpy((Vector6() << 3, -2, 0.1, 0, 0, 1.2).finished());

class SimulatedPeople : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    simulator::SimulationConfig config;
    config.scene = "corridor";
    config.seconds = 1.5;
    config.seed = 70001;
    config.people.count = 6;
    config.out = *made_ / "sim";
    const auto robots = simulator::simulate(config);
    ASSERT_TRUE(robots) << to_string(robots.error());
  }
  static void TearDownTestSuite() { made_.reset(); }

  static fs::path recording() { return *made_ / "sim/robot_1"; }
  static app::RobotProfile profile() { return app::choose_profile({}, recording())->profile; }
  static Outcome evaluate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "evaluate");
    return run(add_evaluate_command, std::move(arguments));
  }
  Outcome people(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"people", (folder_ / "run").string(), "--ground-truth", recording().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return evaluate(std::move(arguments));
  }
  Outcome map() const {
    return evaluate({"map", (folder_ / "run").string(), "--ground-truth", recording().string(), "--trajectory",
                     (folder_ / "run").string(), "--ground-truth-trajectory", recording().string(), "--recording",
                     recording().string(), "--json"});
  }
  /// The run of a robot that knows its path.
  void SetUp() override {
    fs::create_directories(folder_ / "run");
    ASSERT_TRUE(recording::write_tum(folder_ / "run/trajectory.tum", path().poses()));
  }
  static Path path() { return Path::read(recording() / "ground_truth.tum")->moved(kOdom.inverse()); }
  /// Everybody whom the LiDAR sees, told by the run `off` metres beside where they are.
  void write_people(double off) const {
    const auto truth = read_people(recording() / "people.csv");
    std::string text = "t,id,x,y,vx,vy,sigma_m,sightings\n";
    const auto scans = people_scans(recording(), profile(), *truth);
    ASSERT_TRUE(scans) << to_string(scans.error());
    for (const PeopleScan& scan : *scans)
      for (const PeopleScan::Person& p : scan.people) {
        if (p.seen < kVisibleReturns) continue;
        const Eigen::Vector3d in_odom =
            kOdom.inverse() * Eigen::Vector3d(p.position_world.x() + off, p.position_world.y(), 0);
        const auto ns = scan.stamp.time_since_epoch().count();
        char row[160];
        std::snprintf(row, sizeof row, "%lld.%09lld,%d,%.6f,%.6f,0,0,0.1,3\n",
                      static_cast<long long>(ns / 1'000'000'000), static_cast<long long>(ns % 1'000'000'000),
                      static_cast<int>(100 + p.id), in_odom.x(), in_odom.y());
        text += row;
      }
    ASSERT_TRUE(write_file_atomic(folder_ / "run/people.csv", text));
  }
  /// A thermal detector that sees everybody whom the LiDAR sees, and takes each fifth of 30 other things for somebody.
  void write_answers() const {
    const auto truth = read_people(recording() / "people.csv");
    const auto scans = people_scans(recording(), profile(), *truth);
    ASSERT_TRUE(scans) << to_string(scans.error());
    std::string text = "t,camera,x,y,z,verdict,score,distance_m\n";
    const auto add = [&](const PeopleScan& scan, const Eigen::Vector2d& world, const char* verdict, double score) {
      const Eigen::Vector3d p = kOdom.inverse() * Eigen::Vector3d(world.x(), world.y(), 0.9);
      char row[160];
      std::snprintf(row, sizeof row, "%.6f,thermal,%.3f,%.3f,%.2f,%s,%.2f,4\n",
                    to_seconds(scan.stamp.time_since_epoch()), p.x(), p.y(), p.z() - 0.9, verdict, score);
      text += row;
    };
    int others = 0;
    for (const PeopleScan& scan : *scans) {
      for (std::size_t i = 0; i < scan.people.size(); ++i) {
        if (scan.people[i].seen < kVisibleReturns) continue;
        add(scan, scan.people[i].position_world, "person", 0.6 + 0.05 * static_cast<double>(i));
        add(scan, scan.people[i].position_world + Eigen::Vector2d(0.7, 0), "silence", 0);
      }
      for (int k = 0; k < 5 && others < 30; ++k, ++others)
        add(scan, {100.0 + k, 100}, others % 5 == 0 ? "person" : "silence", others % 5 == 0 ? 0.5 : 0);
    }
    ASSERT_TRUE(write_file_atomic(folder_ / "run/answers.csv", text));
  }
  /// The map of that run, with people or without.
  void write_map(bool with_people) const {
    Workers workers(1);
    mapping::Mapper mapper({}, workers);
    ASSERT_TRUE(for_each_true_scan(recording(), profile(), path(), [&](const TrueScan& scan) {
      std::vector<Eigen::Vector3f> points, movers;
      for (const TrueScan::Return& r : scan.returns)
        (r.class_id == MoverTruth::kPersonId ? movers : points).push_back(r.point);
      if (with_people) points.insert(points.end(), movers.begin(), movers.end());
      ASSERT_TRUE(mapper.insert(points, scan.T_path_lidar.translation().cast<float>()));
    }));
    ASSERT_TRUE(mapping::save_cairn(mapper.tree(), folder_ / "run/map.cairn"));
  }

  static inline std::unique_ptr<TemporaryFolder> made_;
  TemporaryFolder folder_;
};

TEST_F(SimulatedPeople, AreAllFoundByARunThatKnowsThem) {
  write_people(0);
  const Outcome o = people({"--view", "around", "--json"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto json = o.json();
  EXPECT_GT(json["people"], 10);
  EXPECT_EQ(json["mota"], 1.0);
  EXPECT_EQ(json["precision"], 1.0);
  EXPECT_EQ(json["recall"], 1.0);
  EXPECT_EQ(json["id_switches"], 0);
  EXPECT_LT(json["position_rmse_m"], 1e-4);
  EXPECT_EQ(json["ghost_p95_s"], 0.0);
  EXPECT_EQ(json["around"]["mota"], 1.0);
  EXPECT_EQ(json["rows_without_scan"], 0);
}

TEST_F(SimulatedPeople, DetailsSayWhoWasMissedWhereAndWhen) {
  write_people(1.5);
  const fs::path file = folder_ / "details.csv";
  const auto json = people({"--view", "around", "--json", "--details", file.string()}).json();
  const auto bytes = read_file(file, 1 << 20);
  ASSERT_TRUE(bytes) << to_string(bytes.error());
  const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  EXPECT_THAT(text, ::testing::StartsWith("t,what,person,track,x,y\n"));
  const auto rows_with = [&](const std::string& what) {
    int rows = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++rows;
    return rows;
  };
  EXPECT_EQ(rows_with(",missed,"), json["people"].get<int>() - json["found"].get<int>());
  EXPECT_EQ(rows_with(",false,-1,"), json["false_tracks"]);
  EXPECT_EQ(rows_with(",switched,"), json["id_switches"]);
  EXPECT_THAT(people({"--view", "around", "--details", "/nowhere/details.csv"}).err, HasSubstr("/nowhere"));
}

TEST_F(SimulatedPeople, AreMissedByTracksBesideThem) {
  write_people(0.5);
  EXPECT_NEAR(people({"--view", "around", "--json"}).json()["position_rmse_m"], 0.5, 0.01);
  write_people(40);
  const auto json = people({"--view", "around", "--json"}).json();
  EXPECT_EQ(json["recall"], 0.0);
  EXPECT_EQ(json["false_tracks"], 0) << "beyond 15 m nothing counts";
  EXPECT_GT(people({"--view", "around", "--within", "1000", "--json"}).json()["false_tracks"], 0);
}

TEST_F(SimulatedPeople, FaultsSayWhatAndWhere) {
  EXPECT_THAT(people({}).err, HasSubstr("people.csv"));
  write_people(0);
  EXPECT_THAT(people({}).err, HasSubstr("--view"));  // there is no camera
  EXPECT_EQ(people({"--view", "both"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(people({"--within", "0"}).exit_code, app::kWrongArguments);
  ASSERT_TRUE(write_file_atomic(folder_ / "run/people.csv", "t,id,x,y\n99999,0,0,0\n"));
  EXPECT_THAT(people({"--view", "around"}).err, HasSubstr("no time of the run's people is that of a scan"));
}

TEST_F(SimulatedPeople, ARecordingThatDoesNotSayWhoIsAPersonIsRefused) {
  fs::copy(recording(), folder_ / "copy");
  fs::resize_file(folder_ / "copy/lidar_labels.bin", 384 * 10);
  write_people(0);
  const std::vector<std::string> command{"people",         (folder_ / "run").string(),
                                         "--ground-truth", (folder_ / "copy/people.csv").string(),
                                         "--view",         "around"};
  EXPECT_THAT(evaluate(command).err, HasSubstr("lidar_labels.bin"));
  fs::remove(folder_ / "copy/lidar_labels.bin");
  EXPECT_THAT(evaluate(command).err, HasSubstr("--people"));
}

TEST_F(SimulatedPeople, DetectorsAreCountedAgainstTheTruth) {
  write_answers();
  const std::vector<std::string> command{"detectors", (folder_ / "run").string(), "--ground-truth",
                                         recording().string()};
  auto as_json = command;
  as_json.push_back("--json");
  const Outcome o = evaluate(as_json);
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto json = o.json();
  EXPECT_GE(json["thermal"]["people"], 20);
  EXPECT_GE(json["thermal"]["people_boxed"], 20);
  EXPECT_EQ(json["thermal"]["others"], 30);
  EXPECT_EQ(json["thermal"]["others_boxed"], 6) << "each fifth";
  EXPECT_GT(json["thermal"]["score_slope"], 0);
  EXPECT_TRUE(json["visible"].is_null());
  EXPECT_GT(json["unclear"], 0);
  EXPECT_THAT(evaluate(command).out, HasSubstr("thermal: {recall: 0."));
}

TEST_F(SimulatedPeople, FaultsOfDetectorsSayWhatToDo) {
  const std::string folder = (folder_ / "run").string();
  EXPECT_THAT(evaluate({"detectors", folder, "--ground-truth", recording().string()}).err, HasSubstr("log_answers"));
  EXPECT_THAT(evaluate({"detectors", folder, folder, "--ground-truth", recording().string()}).err,
              HasSubstr("2 runs, 1 recordings"));
  EXPECT_EQ(evaluate({"detectors", folder}).exit_code, app::kWrongArguments);
}

TEST_F(SimulatedPeople, AMapWithoutThemIsPerfectAndOneWithThemIsNot) {
  write_map(false);
  const Outcome without = map();
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_EQ(without.json()["static_accuracy"], 1.0);
  EXPECT_EQ(without.json()["dynamic_accuracy"], 1.0);
  EXPECT_GT(without.json()["static_voxels"], 1000);
  EXPECT_GT(without.json()["movers_voxels"], 20);
  write_map(true);
  EXPECT_EQ(map().json()["static_accuracy"], 1.0);
  EXPECT_LT(map().json()["dynamic_accuracy"], 0.9);
}

}  // namespace
}  // namespace cairn::cli
