// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/paired_pictures.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using labelling::LocatedScans;

constexpr std::size_t kMostWaiting = 32;  // pictures; at 30 Hz these are a second

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

PairedPictures::PairedPictures(const app::RobotProfile& profile, std::unique_ptr<OdometryPlayer> player,
                               camera::Camera camera)
    : player_(std::move(player)),
      T_base_lidar_(profile.robot().T_base_lidar),
      side_by_side_(profile.camera.driver.side_by_side),
      camera_(std::move(camera)) {}

Result<std::unique_ptr<PairedPictures>> PairedPictures::open(const fs::path& recording,
                                                             const app::RobotProfile& profile) {
  auto player = OdometryPlayer::open(recording, profile, recording::kCamera);
  if (!player) return player.error();
  auto camera = camera::Camera::create(profile.camera.driver);
  if (!camera) return camera.error();
  return std::unique_ptr<PairedPictures>(new PairedPictures(profile, *std::move(player), *std::move(camera)));
}

void PairedPictures::take_scan(const Scan& scan, const odometry::OdometryUpdate& motion, std::uint32_t epoch) {
  if (!scans_.add(motion.stamp, motion.T_odom_base.mean, motion.twist, epoch, motion.points_base)) return;
  half_sweep_ = (scan.valid.end - scan.valid.start) / 2;
  const auto edges = finder_.find(scan.cloud, motion.points_base, T_base_lidar_.rotation());
  edges_.push_back({.stamp = motion.stamp, .edges = {edges.begin(), edges.end()}});
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

Result<void> PairedPictures::for_each(int every, const std::function<Result<void>(const PicturePair&)>& use) {
  const auto played = player_->play({.packet = [&](const Packet& packet) { take_picture(packet, every); },
                                     .scan = [this](const Scan& scan, const odometry::OdometryUpdate& motion,
                                                    std::uint32_t epoch) { take_scan(scan, motion, epoch); },
                                     .after = [&] { return serve(false, use); }});
  return played ? serve(true, use) : played;
}

}  // namespace cairn::cli
