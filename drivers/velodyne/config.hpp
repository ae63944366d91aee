// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/config/config.hpp"

namespace cairn::velodyne {

/// One sensor: how it is reached and how its packets become scans.
struct Config {
  std::string model = "VLP-16";
  std::string bind_address;    ///< of this computer; empty: all
  std::string source_address;  ///< of the sensor; empty: any
  int data_port = 2368;
  int position_port = 8308;
  int receive_buffer_bytes = 4 << 20;
  int max_packets_per_s = 8000;
  std::string return_mode = "any";
  double rpm = 600;
  double cut_angle_deg = 0;
  double timeout_turns = 1.5;
  std::vector<double> field_of_view_deg{0, 360};
  double min_range_m = 0.4;
  double max_range_m = 130;
  std::vector<double> body_box_m{0, 0, 0, 0, 0, 0};
  std::string time_source = "arrival";
};

/// Keys, units and bounds of a Config.
void declare(config::Section& section, Config& config);
/// What bounds alone cannot say: faults between keys and unreadable addresses, all in one Error.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::velodyne
