// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/clients/messages/record.hpp"

namespace cairn::clients {

/// What robot.sock has to offer. One bit each.
enum class Stream : std::uint32_t {
  kPose = 1,
  kState = 2,
  kOwnTiles = 4,
  kTeamTiles = 8,
  kScan = 16,
  kEvents = 32,
  kPeople = 64,
  kTeamPeople = 128,  ///< those whom peers follow
  kCameras = 256,     ///< which cameras there are, once
  kPictures = 512,
  kWheels = 1024,
  kThermal = 2048,  ///< thermal clouds
};
inline constexpr std::uint32_t kAllStreams = 4095;

/// What a client of robot.sock wants from now on. A second one replaces the first.
struct SubscribeMessage {
  static constexpr RecordKind kKind = RecordKind::kSubscribe;
  static constexpr double kMaxPose_hz = 200;

  std::uint32_t streams = 0;  ///< bits of Stream
  double pose_hz = 0;         ///< 0: the pose of each scan; otherwise predictions, too, so often a second
  double scan_hz = 0;         ///< 0: all scans and thermal clouds; otherwise at most so many a second
  float picture_hz = 0;       ///< 0: all pictures; otherwise at most so many a second, of each camera
  /// What the client has of a map already. It gets what is newer, or everything if the core knows no such session.
  struct Resume {
    std::uint64_t session = 0;
    std::uint32_t epoch = 0;
    std::uint64_t version = 0;
    friend bool operator==(const Resume&, const Resume&) = default;
  };
  Resume own, team;

  /// Whether a stream is asked for.
  [[nodiscard]] bool wants(Stream stream) const { return (streams & static_cast<std::uint32_t>(stream)) != 0; }
  /// Asks for one more stream.
  void add(Stream stream) { streams |= static_cast<std::uint32_t>(stream); }
};

/// Appends the body. It is: streams (4), rate of pictures (4), the other rates (8 each); then for the own and for the
/// team's map session (8), version (8), epoch (4), zeros (4).
void encode(const SubscribeMessage& message, std::vector<std::byte>& out);
/// Error kMalformed: also for a stream that does not exist, or a rate that is too high.
[[nodiscard]] Result<SubscribeMessage> decode_subscribe(std::span<const std::byte> body);

}  // namespace cairn::clients
