// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/point_cloud.hpp"

namespace cairn::app {

/// A recording in the making, whose first source is a VLP-16 that is kept as whole scans.
class ScanRecording {
 public:
  explicit ScanRecording(const std::filesystem::path& folder, const Vector6& mount, bool with_gpio = false) {
    recording::Recording index;
    index.robot = "husky_1";
    index.sources.push_back({"lidar", recording::kScans, "data.csv", "lidar", "VLP-16", mount});
    if (with_gpio) index.sources.push_back({"gpio", recording::kGpio, "gpio.csv", "base_link", ""});
    auto writer = recording::RecordingWriter::create(folder, index);
    EXPECT_TRUE(writer) << to_string(writer.error());
    if (writer) writer_.emplace(*std::move(writer));
  }
  void add(const Scan& scan) {
    Packet packet;
    packet.channel = static_cast<std::uint16_t>(recording::ScanLayout::kXyziOffset);
    packet.arrival = scan.valid.end;
    packet.bytes = recording::encode_scan(scan.cloud, true);
    ASSERT_TRUE(writer_ && writer_->write(packet));
  }
  void close() { ASSERT_TRUE(writer_ && writer_->close()); }

 private:
  std::optional<recording::RecordingWriter> writer_;
};

}  // namespace cairn::app
