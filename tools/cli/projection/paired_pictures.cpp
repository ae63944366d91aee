// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/paired_pictures.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/velodyne/lidar.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using labelling::LocatedScans;

constexpr std::size_t kMostWaiting = 32;  // pictures; at 30 Hz these are a second

/// Index of the last source of one of these kinds.
std::optional<std::size_t> find_source(const recording::Recording& recording,
                                       std::initializer_list<recording::SensorKind> kinds) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < recording.sources.size(); ++i)
    if (std::find(kinds.begin(), kinds.end(), recording.sources[i].kind) != kinds.end()) found = i;
  return found;
}

Result<std::unique_ptr<ScanDecoder>> make_decoder(const recording::SourceEntry& entry, SourceId id,
                                                  const app::RobotProfile& profile, Monitor& monitor) {
  if (entry.kind == recording::kScans)
    return std::unique_ptr<ScanDecoder>(std::make_unique<recording::ScanFileDecoder>(entry.deskewed));
  auto lidar = velodyne::Lidar::create(profile.lidar.driver, id, monitor);
  if (!lidar) return lidar.error();
  return std::unique_ptr<ScanDecoder>(*std::move(lidar));
}

Error lacks(const fs::path& recording, std::string_view what) {
  return {Errc::kNotFound, "the recording lacks a sensor", recording.string(), {}, std::string(what)};
}

/// The part that belongs to the left eye, in memory of its own.
Image left_eye(const Image& both, bool side_by_side) {
  if (!side_by_side) return both;
  const auto eyes = camera::split_side_by_side(both.view());
  if (!eyes) return both;
  Image left = both;
  left.resize(both.format, eyes->left.width, eyes->left.height);
  for (int y = 0; y < left.height; ++y)
    std::memcpy(left.bytes.data() + static_cast<std::size_t>(y) * left.stride, eyes->left.row(y).data(), left.stride);
  return left;
}

}  // namespace

PairedPictures::PairedPictures(const app::RobotProfile& profile, std::unique_ptr<recording::RecordingReader> reader,
                               camera::Camera camera)
    : reader_(std::move(reader)),
      workers_(static_cast<unsigned>(profile.threads)),
      T_base_lidar_(profile.robot().T_base_lidar),
      most_steps_(odometry::most_steps(profile.odometry)),
      side_by_side_(profile.camera.driver.side_by_side),
      camera_(std::move(camera)),
      odometry_(profile.odometry, T_base_lidar_, workers_) {}

Result<std::unique_ptr<PairedPictures>> PairedPictures::open(const fs::path& recording,
                                                             const app::RobotProfile& profile) {
  auto reader = recording::RecordingReader::open(recording);
  if (!reader) return reader.error();
  const auto& sources = (*reader)->recording();
  const auto lidar = find_source(sources, {recording::kVelodyne, recording::kScans});
  const auto eye = find_source(sources, {recording::kCamera});
  if (!lidar) return lacks(recording, "a LiDAR");
  if (!eye) return lacks(recording, "a camera");
  auto camera = camera::Camera::create(profile.camera.driver);
  if (!camera) return camera.error();
  const recording::SourceEntry entry = sources.sources[*lidar];
  std::unique_ptr<PairedPictures> pairs(new PairedPictures(profile, *std::move(reader), *std::move(camera)));
  pairs->lidar_id_ = static_cast<SourceId>(*lidar);
  pairs->camera_id_ = static_cast<SourceId>(*eye);
  auto decoder = make_decoder(entry, pairs->lidar_id_, profile, pairs->monitor_);
  if (!decoder) return decoder.error();
  pairs->lidar_ = *std::move(decoder);
  return pairs;
}

void PairedPictures::take_scan(const Scan& scan) {
  Budget budget = Budget::steps(most_steps_);
  const auto motion = odometry_.update(scan, budget);
  if (!motion || motion->lost) {
    ++scans_without_pose_;
    return;
  }
  if (motion->began || motion->reinitialised) ++epoch_;
  if (!scans_.add(motion->stamp, motion->T_odom_base.mean, motion->twist, epoch_, motion->points_base)) return;
  half_sweep_ = (scan.valid.end - scan.valid.start) / 2;
  const auto edges = finder_.find(scan.cloud, motion->points_base, T_base_lidar_.rotation());
  edges_.push_back({.stamp = motion->stamp, .edges = {edges.begin(), edges.end()}});
  while (!edges_.empty() && edges_.front().stamp < scans_[0].stamp) edges_.pop_front();
}

void PairedPictures::take_picture(const Packet& packet, int every) {
  const auto picture = camera_.decode(packet);
  if (!picture) {
    ++unreadable_;
    return;
  }
  if (decoded_++ % static_cast<std::size_t>(every) != 0) return;
  ++pictures_;
  waiting_.push_back(left_eye(**picture, side_by_side_));
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  ++without_scan_;
}

Result<void> PairedPictures::serve_one(const Image& picture, const Use& use) {
  const labelling::PlacedScan* scan = scans_.nearest(picture.stamp + half_sweep_);
  const auto T_odom_base = scans_.pose_at(picture.stamp, LocatedScans::Beyond::kExtrapolate);
  if (scan == nullptr || !T_odom_base) {
    ++without_scan_;
    return {};
  }
  const auto edges = std::find_if(edges_.begin(), edges_.end(), [&](const auto& e) { return e.stamp == scan->stamp; });
  if (edges == edges_.end()) return {};
  return use({.picture = picture, .scan = *scan, .edges = edges->edges, .T_odom_base = *T_odom_base});
}

/// A picture waits until the scan that begins at it has ended.
Result<void> PairedPictures::serve(bool all, const Use& use) {
  while (!waiting_.empty()) {
    const Image& picture = waiting_.front();
    const bool ready = scans_.size() > 0 && scans_[scans_.size() - 1].stamp >= picture.stamp + 2 * half_sweep_;
    if (!all && !ready) return {};
    if (auto used = serve_one(picture, use); !used) return used;
    waiting_.pop_front();
  }
  return {};
}

Result<void> PairedPictures::for_each(int every, const Use& use) {
  for (Packet packet;;) {
    const auto poll = reader_->next(packet, {});
    if (!poll) ++unreadable_;
    if (!poll || *poll == Poll::kTimeout) continue;
    if (*poll == Poll::kEnd) break;
    if (packet.source == camera_id_) take_picture(packet, every);
    if (packet.source != lidar_id_) continue;
    const auto scan = lidar_->decode(packet);
    if (!scan) ++unreadable_;
    if (scan && *scan != nullptr) take_scan(**scan);
    if (auto served = serve(false, use); !served) return served;
  }
  if (const Scan* last = lidar_->flush()) take_scan(*last);
  return serve(true, use);
}

}  // namespace cairn::cli
