// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/odometry_player.hpp"

#include <algorithm>
#include <utility>

#include "tools/cli/projection/recorded_lidar.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

Error lacks(const fs::path& recording, std::string_view what) {
  return {Errc::kNotFound, "the recording lacks a sensor", recording.string(), {}, std::string(what)};
}

}  // namespace

OdometryPlayer::OdometryPlayer(const app::RobotProfile& profile, std::unique_ptr<recording::RecordingReader> reader)
    : reader_(std::move(reader)),
      workers_(static_cast<unsigned>(profile.threads)),
      most_steps_(odometry::most_steps(profile.odometry)),
      odometry_(profile.odometry, profile.robot().T_base_lidar, workers_) {}

Result<std::unique_ptr<OdometryPlayer>> OdometryPlayer::open(const fs::path& recording,
                                                             const app::RobotProfile& profile,
                                                             recording::SensorKind kind) {
  auto reader = recording::RecordingReader::open(recording);
  if (!reader) return reader.error();
  const recording::Recording& sources = (*reader)->recording();
  const auto lidar = lidar_of(sources);
  const auto other = std::ranges::find(sources.sources, kind, &recording::SourceEntry::kind);
  if (!lidar) return lacks(recording, "a LiDAR");
  if (other == sources.sources.end())
    return lacks(recording, kind == recording::kThermal ? "a thermal camera" : "a camera");
  const recording::SourceEntry entry = sources.sources[*lidar];
  std::unique_ptr<OdometryPlayer> player(new OdometryPlayer(profile, *std::move(reader)));
  player->lidar_id_ = static_cast<SourceId>(*lidar);
  player->other_id_ = static_cast<SourceId>(other - sources.sources.begin());
  auto decoder = decoder_of(entry, player->lidar_id_, profile, player->monitor_);
  if (!decoder) return decoder.error();
  player->lidar_ = *std::move(decoder);
  return player;
}

void OdometryPlayer::take_scan(const Scan& scan, const Use& use) {
  Budget budget = Budget::steps(most_steps_);
  const auto motion = odometry_.update(scan, budget);
  if (!motion || motion->lost) {
    ++scans_without_pose_;
    return;
  }
  if (motion->began || motion->reinitialised) ++epoch_;
  use.scan(scan, *motion, epoch_);
}

Result<void> OdometryPlayer::take(const Packet& packet, const Use& use) {
  if (packet.source == other_id_) use.packet(packet);
  if (packet.source != lidar_id_) return {};
  const auto scan = lidar_->decode(packet);
  if (!scan) ++unreadable_;
  if (scan && *scan != nullptr) take_scan(**scan, use);
  return use.after();
}

Result<void> OdometryPlayer::play(const Use& use) {
  for (Packet packet;;) {
    const auto poll = reader_->next(packet, {});
    if (!poll) ++unreadable_;
    if (!poll || *poll == Poll::kTimeout) continue;
    if (*poll == Poll::kEnd) break;
    if (auto taken = take(packet, use); !taken) return taken;
  }
  if (const Scan* last = lidar_->flush()) take_scan(*last, use);
  return use.after();
}

}  // namespace cairn::cli
