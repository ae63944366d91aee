// SPDX-License-Identifier: Apache-2.0
// Another vendor's DDS (Fast DDS, as most of ROS uses it) beside a live core and its cairn-ros: it arms the robot,
// drives a bend, stops it, and keeps what it read. So a whole chain can be compared with what the core itself wrote.
//   ros_drive DOMAIN ROBOT [key=value …]
//   keys: seconds (20), v (0.4 m/s), w (0.2 rad/s)
// It prints how much of each topic came and the last diagnostics, and leaves odom.tum (the core's time line, if both
// run on one machine) and, of a map that is not binary, map.ot in the working folder. cairn-ros needs --interface lo
// --peer 127.0.0.1, and
// --command-socket.
#include <octomap/OcTree.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/clock.hpp"
#include "tests/tools/ros/process/fast_dds.hpp"

namespace cairn::bench {
namespace {

using ros::fast::Fields;
using ros::fast::Payload;
using ros::fast::take;

std::map<std::string, double> g_keys{{"seconds", 20}, {"v", 0.4}, {"w", 0.2}};

/// The topics of one robot, and what came of them.
class Reader {
 public:
  Reader(unsigned domain, const std::string& robot)
      : network_(domain),
        odom_(network_.reader("rt/" + robot + "/odom", "nav_msgs::msg::dds_::Odometry_", ros::fast::default_qos())),
        points_(network_.reader("rt/" + robot + "/points", "sensor_msgs::msg::dds_::PointCloud2_",
                                ros::fast::sensor_qos())),
        map_(network_.reader("rt/" + robot + "/map", "octomap_msgs::msg::dds_::Octomap_", ros::fast::latched_qos())),
        diagnostics_(network_.reader("rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_",
                                     ros::fast::default_qos())),
        cmd_vel_(network_.writer("rt/" + robot + "/cmd_vel", "geometry_msgs::msg::dds_::Twist_")),
        arm_(network_.writer("rt/" + robot + "/arm", "std_msgs::msg::dds_::Bool_")),
        stop_(network_.writer("rt/" + robot + "/stop", "std_msgs::msg::dds_::Bool_")) {}

  /// Reads for so long, and says the velocity 20 times a second.
  void go(double seconds, double v, double w) {
    const LiveClock clock;
    const Time end = clock.now() + from_seconds(seconds);
    Payload twist = ros::fast::payload_of(v, 0.0, 0.0, 0.0, 0.0, w);
    for (Time next = clock.now(); next < end; next += std::chrono::milliseconds(50)) {
      LiveClock::wait_until(next);
      if (driving_) cmd_vel_->write(&twist);
      read();
    }
  }
  /// Asks to be armed until something is there that reads it, then once more.
  void arm() {
    Payload yes = ros::fast::payload_of(true);
    arm_->write(&yes);
    driving_ = true;
  }
  void stop() {
    Payload yes = ros::fast::payload_of(true);
    stop_->write(&yes);
    driving_ = false;
  }

  void report() const {
    std::printf("odom %zu, points %zu clouds of %zu points, maps %zu of %zu bytes, diagnostics %zu\n", poses_.size(),
                clouds_, clouds_ == 0 ? 0 : cloud_points_ / clouds_, maps_, map_bytes_, diagnosed_);
    std::printf("%s", statuses_.c_str());
    if (const auto written = recording::write_tum("odom.tum", poses_); !written)
      std::printf("odom.tum: %s\n", to_string(written.error()).c_str());
    if (tree_) tree_->write("map.ot");
    if (poses_.empty()) return;
    const auto& p = poses_.back().pose.translation();
    std::printf("last pose %.3f %.3f %.3f\n", p.x(), p.y(), p.z());
  }

 private:
  void read() {
    while (auto message = take(odom_)) read_odom(*message);
    while (auto message = take(points_)) read_points(*message);
    while (auto message = take(map_)) read_map(*message);
    while (auto message = take(diagnostics_)) read_diagnostics(*message);
  }
  static Time stamp(Fields& fields) {
    const auto seconds = fields.next<std::int32_t>();
    const auto nanoseconds = fields.next<std::uint32_t>();
    return Time{std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds) - offset()};
  }
  static Duration offset() {
    static const Duration once = LiveClock::realtime_offset();
    return once;
  }
  /// Keeps the last as text, one status a line.
  void read_diagnostics(Payload& message) {
    Fields fields(message);
    (void)stamp(fields);
    (void)fields.text();
    ++diagnosed_;
    statuses_.clear();
    for (auto left = fields.next<std::uint32_t>(); left > 0; --left) {
      const int level = fields.next<std::uint8_t>();
      const std::string name = fields.text(), said = fields.text();
      (void)fields.text();
      statuses_ += std::to_string(level) + " " + name + ": " + said;
      for (auto values = fields.next<std::uint32_t>(); values > 0; --values) {
        const std::string key = fields.text();
        statuses_ += ", " + key + " " + fields.text();
      }
      statuses_ += '\n';
    }
  }
  void read_odom(Payload& message) {
    Fields fields(message);
    const Time time = stamp(fields);
    (void)fields.text();
    (void)fields.text();
    const auto p = fields.reals(3), q = fields.reals(4);
    poses_.push_back({time, SE3(Eigen::Quaterniond(q[3], q[0], q[1], q[2]), Eigen::Vector3d(p[0], p[1], p[2]))});
  }
  void read_points(Payload& message) {
    Fields fields(message);
    (void)stamp(fields);
    (void)fields.text();
    (void)fields.next<std::uint32_t>();
    cloud_points_ += fields.next<std::uint32_t>();
    ++clouds_;
  }
  void read_map(Payload& message) {
    Fields fields(message);
    (void)stamp(fields);
    (void)fields.text();
    const bool binary = fields.next<bool>();
    (void)fields.text();
    auto tree = std::make_unique<octomap::OcTree>(fields.next<double>());
    const auto data = fields.next<std::vector<std::int8_t>>();
    ++maps_;
    map_bytes_ = data.size();
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data.data()), data.size()));
    if (binary) return;
    tree->readData(stream);
    tree_ = std::move(tree);
  }

  ros::fast::FastRos network_;
  ros::fast::DataReader *odom_, *points_, *map_, *diagnostics_;
  ros::fast::DataWriter *cmd_vel_, *arm_, *stop_;
  bool driving_ = false;
  std::vector<recording::StampedPose> poses_;
  std::size_t clouds_ = 0, cloud_points_ = 0, maps_ = 0, map_bytes_ = 0, diagnosed_ = 0;
  std::unique_ptr<octomap::OcTree> tree_;
  std::string statuses_;
};

int run(unsigned domain, const std::string& robot) {
  Reader reader(domain, robot);
  reader.go(5, 0, 0);  // discovery
  reader.arm();
  reader.go(2, 0, 0);  // the motors become enabled
  reader.go(g_keys["seconds"], g_keys["v"], g_keys["w"]);
  reader.stop();
  reader.go(4, 0, 0);  // the last maps
  reader.report();
  return 0;
}

}  // namespace
}  // namespace cairn::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::puts("ros_drive DOMAIN ROBOT [key=value ...]: see the top of its source");
    return 2;
  }
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    if (!cairn::bench::g_keys.contains(word.substr(0, equals))) return 2;
    cairn::bench::g_keys[word.substr(0, equals)] = std::strtod(word.c_str() + equals + 1, nullptr);
  }
  return cairn::bench::run(static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10)), argv[2]);
}
