// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/velodyne/transport/udp_sender.hpp"
#include "hal/clock.hpp"
#include "hal/packet.hpp"
#include "tests/support/own_address.hpp"

namespace cairn::support {

/// A LiDAR whose datagrams go to this process's own loopback address.
class LoopbackLidar {
 public:
  /// The lines of a robot's profile by which it hears the LiDAR, mounted at `T_base_lidar` ("[x, y, z, r, p, y]").
  static std::string profile(const std::string& T_base_lidar) {
    return "lidar:\n  bind_address: " + own_address() + "\n  data_port: " + std::to_string(kDataPort) +
           "\n  position_port: " + std::to_string(kPositionPort) + "\n  T_base_lidar: " + T_base_lidar + "\n";
  }

  /// Sends the packets at least as far apart as they came: after a pause of the whole machine, no faster than before.
  /// Until `stop` says true.
  void send(const std::vector<Packet>& packets, const std::function<bool()>& stop) {
    for (std::size_t i = 0; i < packets.size() && !stop(); ++i) {
      const Time now = clock_.now();
      if (!due_) due_ = now;
      if (i > 0) due_ = *due_ + (packets[i].arrival - packets[i - 1].arrival);
      due_ = std::max(*due_, now - kBurst);
      LiveClock::wait_until(*due_);
      (void)wire_->send(packets[i].payload(), kDataPort);  // nobody may listen just now
    }
  }

 private:
  static constexpr std::uint16_t kDataPort = 22368, kPositionPort = 28308;  // the system hands out none below 32768
  static constexpr Duration kBurst = std::chrono::milliseconds(20);

  LiveClock clock_;
  std::unique_ptr<velodyne::UdpSender> wire_ = velodyne::UdpSender::open(own_address()).value();
  std::optional<Time> due_;
};

}  // namespace cairn::support
