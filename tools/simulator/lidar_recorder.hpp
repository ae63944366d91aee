// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hal/packet.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/lidar/lidar.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::simulator {

/// Takes a packet of one sensor, in the order of arrival.
using Sink = std::function<Result<void>(const Packet&)>;
/// Takes the true classes of one data packet's or one picture's measurements.
using LabelSink = std::function<Result<void>(std::span<const std::byte>)>;

/// Hands all packets of `lidar` until `end` to `sink`, and the classes of each data packet to `labels` where there is
/// one; counts into `summary`.
Result<void> record_lidar(const Lidar& lidar, Time end, Workers& workers, const Sink& sink, const LabelSink& labels,
                          RobotSummary& summary, const Progress& progress);

}  // namespace cairn::simulator
