// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/config.hpp"

#include <arpa/inet.h>

#include "drivers/velodyne/models.hpp"

namespace cairn::velodyne {
namespace {

std::vector<std::string> model_options() {
  std::vector<std::string> options;
  for (const Model& m : models()) {
    options.emplace_back(m.name);
    if (!m.alias.empty()) options.emplace_back(m.alias);
  }
  return options;
}

bool is_address(const std::string& text) {
  in_addr address{};
  return text.empty() || inet_pton(AF_INET, text.c_str(), &address) == 1;
}

}  // namespace

void declare(config::Section& s, Config& c) {
  s.choice("model", c.model, model_options(), "sensor model");
  s.text("bind_address", c.bind_address, "IPv4 address of this computer to listen on; empty: all");
  s.text("source_address", c.source_address,
         "IPv4 address of the sensor; other senders are ignored; empty: the first that sends valid packets");
  s.integer("data_port", c.data_port, {1, 65535}, "", "UDP port of data packets");
  s.integer("position_port", c.position_port, {1, 65535}, "", "UDP port of position packets");
  s.integer("receive_buffer_bytes", c.receive_buffer_bytes, {65536, 1 << 28}, "B",
            "socket buffer to ask for; the kernel grants net.core.rmem_max at most");
  s.integer("max_packets_per_s", c.max_packets_per_s, {100, 100000}, "1/s",
            "further packets are dropped before they are decoded");
  s.choice("return_mode", c.return_mode, {"any", "strongest", "last", "dual"},
           "how the sensor should be set; an event says if it is not");
  s.number("rpm", c.rpm, {300, 1200}, "1/min", "motor speed, used until the packets tell it");
  s.number("cut_angle_deg", c.cut_angle_deg, {0, 360}, "deg", "azimuth where a scan ends; clockwise, 0 = forward");
  s.number("timeout_turns", c.timeout_turns, {1.1, 10}, "turns", "age at which a scan is closed as incomplete");
  s.numbers("field_of_view_deg", c.field_of_view_deg, {0, 360}, "deg",
            "azimuth where the sensor's own field of view starts and ends, clockwise; 0, 360: all around");
  s.number("min_range_m", c.min_range_m, {0, 300}, "m", "nearer points are dropped");
  s.number("max_range_m", c.max_range_m, {0, 300}, "m", "farther points are dropped");
  s.numbers("body_box_m", c.body_box_m, {-10, 10}, "m",
            "x, y, z of the lower and of the upper corner of the robot's body in the sensor frame; points inside are "
            "dropped; all 0: none");
  s.choice("time_source", c.time_source, {"arrival", "pps"},
           "arrival: filtered host time; pps: the sensor's UTC while it is locked, where the host's clock agrees");
}

Result<void> check(const Config& c) {
  std::string faults;
  const auto fault = [&](const std::string& text) { faults += (faults.empty() ? "" : "\n") + text; };
  if (find_model(c.model) == nullptr) fault("model: \"" + c.model + "\" is unknown; there are " + model_names());
  if (c.data_port == c.position_port && c.data_port != 0) fault("data_port and position_port must differ");
  if (c.min_range_m > c.max_range_m) fault("min_range_m must not be above max_range_m");
  if (c.field_of_view_deg.size() != 2) fault("field_of_view_deg takes 2 numbers");
  if (c.body_box_m.size() != 6) {
    fault("body_box_m takes 6 numbers");
  } else {
    bool upside_down = false;
    for (std::size_t i = 0; i < 3; ++i) upside_down = upside_down || c.body_box_m[i] > c.body_box_m[i + 3];
    if (upside_down) fault("body_box_m: the lower corner is above the upper one");
  }
  if (!is_address(c.bind_address)) fault("bind_address: \"" + c.bind_address + "\" is no IPv4 address");
  if (!is_address(c.source_address)) fault("source_address: \"" + c.source_address + "\" is no IPv4 address");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of a LiDAR", {}, {}, faults};
}

}  // namespace cairn::velodyne
