// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <vector>

#include "drivers/camera/frame.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/files/file.hpp"

namespace cairn::cli::test {

/// A grey picture as the camera's packet.
inline Packet grey_packet(std::size_t source, std::uint64_t n, Time stamp, const Image& image) {
  Packet p;
  p.source = static_cast<SourceId>(source);
  p.sequence = n;
  p.arrival = stamp;
  camera::append_header(
      p.bytes, {static_cast<std::uint32_t>(camera::FrameFormat::kGrey), static_cast<std::uint32_t>(image.width),
                static_cast<std::uint32_t>(image.height), static_cast<std::uint32_t>(image.stride), false});
  p.bytes.insert(p.bytes.end(), image.bytes.begin(), image.bytes.end());
  return p;
}

/// The packet of a thermal picture of a board that looks so: what is dark is warm. A count is 0.01 K.
inline Packet thermal_packet(std::size_t source, std::uint64_t n, Time stamp, const Image& grey) {
  Packet p;
  p.source = static_cast<SourceId>(source);
  p.sequence = n;
  p.arrival = stamp;
  const auto width = static_cast<std::uint32_t>(grey.width), height = static_cast<std::uint32_t>(grey.height);
  camera::append_header(p.bytes,
                        {static_cast<std::uint32_t>(camera::FrameFormat::kY16), width, height, 2 * width, false});
  for (const std::byte value : grey.bytes) {
    const unsigned counts = 30000 + 8 * (255 - std::to_integer<unsigned>(value));
    p.bytes.push_back(static_cast<std::byte>(counts & 0xFFU));
    p.bytes.push_back(static_cast<std::byte>(counts >> 8U));
  }
  return p;
}

/// Two pictures of one size beside each other.
inline Image side_by_side(const Image& left, const Image& right) {
  Image both;
  both.resize(left.format, left.width + right.width, left.height);
  for (int y = 0; y < left.height; ++y) {
    std::byte* row = both.bytes.data() + static_cast<std::size_t>(y) * both.stride;
    std::memcpy(row, left.view().row(y).data(), left.stride);
    std::memcpy(row + left.stride, right.view().row(y).data(), right.stride);
  }
  return both;
}

/// A recording of a camera, with the text of its profile.
inline void write_pictures(const std::filesystem::path& folder, const std::vector<Image>& pictures,
                           const std::string& profile) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"camera", recording::kCamera, "camera/data.csv", "camera", ""}};
  auto writer = recording::RecordingWriter::create(folder, r).value();
  for (std::size_t i = 0; i < pictures.size(); ++i)
    ASSERT_TRUE(writer.write(grey_packet(0, i, Time(std::chrono::milliseconds(100 * (i + 1))), pictures[i])));
  ASSERT_TRUE(writer.close());
  ASSERT_TRUE(write_file_atomic(folder / recording::kProfileFile, profile));
}

}  // namespace cairn::cli::test
