// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/recording/formats/recording.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"

namespace cairn::cli {

/// Ports and model of the LiDAR, from the first datagrams of the sensors' sizes. They are empty where there are none.
[[nodiscard]] recording::SourceEntry captured_sensor(velodyne::PcapSource& capture);

}  // namespace cairn::cli
