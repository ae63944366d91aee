// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/config/config.hpp"

namespace cairn::velodyne {

/// One sensor: how it is reached and how its packets become scans. Section `lidar` of the profile.
struct Config {
  std::string model = "VLP-16";        ///< name or alias of a Model
  std::string bind_address;            ///< IPv4 address of this computer to listen on; empty: all
  std::string source_address;          ///< IPv4 address of the sensor; empty: the first sender of valid packets
  int data_port = 2368;                ///< UDP destination port of data packets
  int position_port = 8308;            ///< UDP destination port of position packets
  int receive_buffer_bytes = 4 << 20;  ///< to ask the kernel for; it grants at most net.core.rmem_max
  int max_packets_per_s = 8000;        ///< further packets are dropped before decoding
  std::string return_mode = "any";     ///< how the sensor should be set: any, strongest, last or dual
  double rpm = 600;                    ///< turns per minute, used until the packets tell the real speed
  double cut_angle_deg = 0;            ///< azimuth where a scan ends; clockwise seen from above, 0 = forward
  double timeout_turns = 1.5;          ///< age in turns at which a scan is closed as incomplete
  /// Azimuths where the sensor's own field of view begins and ends, clockwise in degrees; {0, 360} is all around.
  std::vector<double> field_of_view_deg{0, 360};
  double min_range_m = 0.4;  ///< nearer points are dropped
  double max_range_m = 130;  ///< farther points are dropped
  /// Lower and upper corner (x, y, z in metres, sensor frame) of the robot's body: points inside are dropped. All 0:
  /// none.
  std::vector<double> body_box_m{0, 0, 0, 0, 0, 0};
  std::string time_source = "arrival";  ///< arrival: filtered host time; pps: the sensor's UTC while it is locked
};

/// Keys, units and bounds of a Config.
void declare(config::Section& section, Config& config);
/// Checks what bounds cannot: relations between keys, and addresses. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::velodyne
