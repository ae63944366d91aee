// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/chassis/config.hpp"

#include <algorithm>
#include <vector>

#include "drivers/drive/can/bus_name.hpp"

namespace cairn::drive {
namespace {

void declare_nodes(config::Section& s, Config& c) {
  s.integer("host_node", c.host_node, {1, 127}, "", "CANopen node identifier of this computer");
  s.integer("left_node", c.left_node, {1, 127}, "", "node of the left wheel");
  s.integer("right_node", c.right_node, {1, 127}, "", "node of the right wheel");
  s.integer("rear_left_node", c.rear_left_node, {0, 127}, "", "node of a second left wheel; 0: none");
  s.integer("rear_right_node", c.rear_right_node, {0, 127}, "", "node of a second right wheel; 0: none");
  s.flag("left_reversed", c.left_reversed, "the left motors count backwards when the robot goes forward");
  s.flag("right_reversed", c.right_reversed, "the same for the right motors");
  s.number("velocity_units_per_rad_s", c.velocity_units_per_rad_s, {0, 1e8}, "s/rad",
           "object 60FF for 1 rad/s of the wheel, gear included; needed to enable a CiA 402 drive");
  s.number("position_counts_per_rad", c.position_counts_per_rad, {0, 1e8}, "1/rad",
           "object 6064 for 1 rad of the wheel, gear included; needed for odometry");
  s.number("acceleration_m_s2", c.acceleration_m_s2, {0.01, 20}, "m/s²", "ramps of speed: objects 6083 and 6084");
  s.number("quick_stop_m_s2", c.quick_stop_m_s2, {0.01, 50}, "m/s²", "ramp of a quick stop: object 6085");
  s.integer("heartbeat_ms", c.heartbeat_ms, {10, 1000}, "ms", "period of the nodes' heartbeat: object 1017");
  s.integer("host_heartbeat_ms", c.host_heartbeat_ms, {20, 1000}, "ms",
            "a node that does not hear this computer for so long stops by itself: object 1016");
  s.integer("vendor", c.vendor, {0, 2147483647}, "", "vendor of the nodes (object 1018:1); 0: any");
  s.integer("product", c.product, {0, 2147483647}, "", "product of the nodes (object 1018:2); 0: any");
}

void declare_odometry(config::Section& s, Config& c) {
  s.number("travel_noise_m", c.travel_noise_m, {0, 1}, "m", "1 σ of one side's travel after 1 m");
  s.number("travel_scale", c.travel_scale, {0, 0.5}, "", "1 σ of the wheel radius, as a share");
  s.number("rotation_scale", c.rotation_scale, {0, 1}, "", "1 σ of the effective separation, as a share");
  s.number("lateral_slip", c.lateral_slip, {0, 1}, "",
           "1 σ of sideways motion, as a share of the difference in travel of the sides");
  s.number("ground_noise_m", c.ground_noise_m, {0, 1}, "m", "1 σ of the height after 1 m");
  s.number("ground_noise_rad", c.ground_noise_rad, {0, 1}, "rad", "1 σ of roll and pitch after 1 m");
  s.number("traction_m_s2", c.traction_m_s2, {0.1, 50}, "m/s²", "a wheel that changes its speed faster is slipping");
  s.number("slip_factor", c.slip_factor, {0, 2}, "", "share of a slipping wheel's travel that counts as uncertain");
}

}  // namespace

void declare(config::Section& s, Config& c) {
  s.choice("protocol", c.protocol, {"cia402", "agilex"}, "protocol of the motor controllers");
  s.text(
      "interface", c.interface,
      "SocketCAN interface, configured and up: ip link set can0 up type can bitrate 500000; or unix:PATH, a bus that "
      "a program of this machine plays");
  s.number("wheel_separation_m", c.wheel_separation_m, {0, 5}, "m",
           "effective distance of left and right wheels; for skid steering wider than they stand; needed to enable");
  s.number("wheel_radius_m", c.wheel_radius_m, {0, 2}, "m", "needed to enable a CiA 402 drive");
  s.number("max_speed_m_s", c.max_speed_m_s, {0, 10}, "m/s",
           "faster commands are slowed down; the path keeps its curvature");
  s.number("max_yaw_rate_rad_s", c.max_yaw_rate_rad_s, {0, 20}, "rad/s", "the same for turns");
  s.flag("ackermann", c.ackermann, "AgileX Hunter: steers its front wheels instead of driving differentially");
  s.number("wheelbase_m", c.wheelbase_m, {0.05, 5}, "m", "of an Ackermann robot");
  declare_nodes(s, c);
  declare_odometry(s, c);
}

Result<void> check(const Config& c) {
  std::string faults;
  const auto fault = [&](const std::string& text) { faults += (faults.empty() ? "" : "\n") + text; };
  if (c.protocol != "cia402" && c.protocol != "agilex") fault("protocol: there are cia402 and agilex");
  if (!is_bus_name(c.interface)) fault("interface: \"" + c.interface + "\" cannot be the name of an interface");
  std::vector<int> nodes{c.host_node, c.left_node, c.right_node};
  for (const int node : {c.rear_left_node, c.rear_right_node})
    if (node != 0) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) fault("all nodes, the host's too, must differ");
  if (nodes.front() < 1 || nodes.back() > 127) fault("nodes have identifiers 1 … 127");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of a drive", {}, {}, faults};
}

std::string enable_fault(const Config& c) {
  std::string missing;
  const auto need = [&](double value, const char* key) {
    if (!(value > 0)) missing += std::string(missing.empty() ? "" : ", ") + key;
  };
  need(c.wheel_separation_m, "wheel_separation_m");
  if (c.protocol == "cia402") {
    need(c.wheel_radius_m, "wheel_radius_m");
    need(c.velocity_units_per_rad_s, "velocity_units_per_rad_s");
    need(c.position_counts_per_rad, "position_counts_per_rad");
  }
  return missing;
}

}  // namespace cairn::drive
