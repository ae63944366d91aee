// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar_recorder.hpp"

#include <algorithm>

namespace cairn::simulator {
namespace {

constexpr std::size_t kBatch = 512;  // packets that are traced at a time

/// Traces the packets in batches and writes them in the order of their arrival.
class LidarRecorder {
 public:
  LidarRecorder(const Lidar& lidar, Workers& workers, const Sink& sink, RobotSummary& summary)
      : lidar_(lidar),
        workers_(workers),
        sink_(sink),
        summary_(summary),
        batch_(kBatch),
        returns_(kBatch),
        labels_(kBatch) {}

  Result<void> record(Time end, const LabelSink& labels, const Progress& progress) {
    const Time start = lidar_.first_firing(0);
    for (std::uint64_t first = 0; lidar_.arrival(first) <= end; first += kBatch) {
      workers_.for_each(kBatch, [&](std::size_t i) { returns_[i] = lidar_.fill(first + i, batch_[i], &labels_[i]); });
      for (std::size_t i = 0; i < kBatch && lidar_.arrival(first + i) <= end; ++i) {
        if (auto written = write(first + i, i); !written) return written;
        if (!labels) continue;
        if (auto written = labels(std::as_bytes(std::span(labels_[i]))); !written) return written;
      }
      if (progress)
        progress(std::min(1.0, to_seconds(lidar_.arrival(first + kBatch) - start) / to_seconds(end - start)));
    }
    return {};
  }

 private:
  Result<void> write(std::uint64_t n, std::size_t slot) {
    if (n % Lidar::kPositionEvery == 0) {
      // Just ahead of the data packet it accompanies.
      const Time at = lidar_.arrival(n) - std::chrono::microseconds(20);
      lidar_.fill_position(at, position_);
      if (auto sent = send(at, velodyne::kDefaultPositionPort, position_); !sent) return sent;
      ++summary_.position_packets;
    }
    ++summary_.data_packets;
    summary_.shots += velodyne::kBlocks * velodyne::kBlockChannels;
    summary_.returns += static_cast<std::uint64_t>(returns_[slot]);
    return send(lidar_.arrival(n), velodyne::kDefaultDataPort, batch_[slot]);
  }

  Result<void> send(Time arrival, std::uint16_t port, std::span<const std::byte> bytes) {
    packet_.channel = port;
    packet_.arrival = arrival;
    packet_.bytes.assign(bytes.begin(), bytes.end());
    auto written = sink_(packet_);
    ++packet_.sequence;
    return written;
  }

  const Lidar& lidar_;
  Workers& workers_;
  const Sink& sink_;
  RobotSummary& summary_;
  std::vector<Lidar::DataPacket> batch_;
  std::vector<int> returns_;
  std::vector<Lidar::Labels> labels_;
  Lidar::PositionPacket position_{};
  Packet packet_;
};

}  // namespace

Result<void> record_lidar(const Lidar& lidar, Time end, Workers& workers, const Sink& sink, const LabelSink& labels,
                          RobotSummary& summary, const Progress& progress) {
  return LidarRecorder(lidar, workers, sink, summary).record(end, labels, progress);
}

}  // namespace cairn::simulator
