// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "tools/cli/inspect/figures/packet_figures.hpp"
#include "tools/cli/inspect/figures/scan_figures.hpp"
#include "tools/cli/inspect/figures/sensor_figures.hpp"

namespace cairn::cli {

/// Takes a whole recording through its decoders and keeps the figures of every source.
class StreamInspection {
 public:
  /// `wanted_scan`: which scan to keep, counted from 0 over all sources; none: the first complete one.
  /// Error: a source's model is unknown.
  [[nodiscard]] static Result<std::unique_ptr<StreamInspection>> create(const recording::Recording& recording,
                                                                        std::optional<std::uint64_t> wanted_scan);
  void run(Source& source);

  /// One object per source: what the index says, packets, scans, and what the decoder counted.
  [[nodiscard]] report::Json sources() const;
  [[nodiscard]] report::Json events() const;
  [[nodiscard]] report::Json damage() const;
  [[nodiscard]] std::uint64_t damaged() const { return damaged_; }
  /// Of all sources.
  [[nodiscard]] std::uint64_t scans() const { return scans_; }
  /// The wanted scan; without a wish and without a complete scan the first one.
  [[nodiscard]] const std::optional<Scan>& kept() const { return kept_; }

 private:
  struct Stream {
    recording::SourceEntry entry;
    PacketFigures packets;
    ScanFigures scans;
    std::unique_ptr<velodyne::Lidar> lidar;  // exactly one of the three
    std::unique_ptr<recording::ScanFileDecoder> sweeps;
    std::unique_ptr<SensorFigures> sensor;
    [[nodiscard]] Result<const Scan*> decode(const Packet& packet);
    [[nodiscard]] const Scan* flush();
  };

  explicit StreamInspection(std::optional<std::uint64_t> wanted) : wanted_(wanted) {}
  void take(const Packet& packet);
  void take(Stream& stream, const Scan* scan);
  void note(const Error& error);

  Monitor monitor_;
  std::vector<Stream> streams_;
  std::optional<std::uint64_t> wanted_;
  std::optional<Scan> kept_;
  std::uint64_t scans_ = 0, damaged_ = 0;
  std::vector<std::string> damage_;  // the first of them
};

}  // namespace cairn::cli
