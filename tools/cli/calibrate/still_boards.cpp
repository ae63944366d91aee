// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/still_boards.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "drivers/recording/recording_reader.hpp"
#include "onboard/perception/calibration/eyes_problem.hpp"
#include "tools/cli/projection/recorded_lidar.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using calibration::Board;
using calibration::BoardPose;
using calibration::Corners;

constexpr std::size_t kMostScans = 20;  // of one pose

double largest_motion(const Corners& a, const Corners& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

/// Collects the pictures of one still time.
class Still {
 public:
  explicit Still(const SeenBoard& first) : first_(&first) {
    still_ = {.recording = first.recording,
              .first = first.stamp,
              .last = first.stamp,
              .pictures = 1,
              .corners = first.eyes[0]};
  }
  /// False: it does not belong to this time.
  bool add(const SeenBoard& seen, double most_motion) {
    const Corners corners = calibration::ordered_like(first_->eyes[0], seen.eyes[0]);
    if (seen.recording != still_.recording || seen.stamp - still_.last > kMostStillGap ||
        largest_motion(first_->eyes[0], corners) > most_motion)
      return false;
    for (std::size_t i = 0; i < corners.size(); ++i) still_.corners[i] += corners[i];
    still_.last = seen.stamp;
    ++still_.pictures;
    return true;
  }
  [[nodiscard]] std::optional<StillBoard> result() const {
    if (still_.pictures < kLeastStill || still_.last - still_.first < kLeastStillTime) return {};
    StillBoard mean = still_;
    for (Eigen::Vector2d& p : mean.corners) p /= static_cast<double>(still_.pictures);
    return mean;
  }

 private:
  const SeenBoard* first_;
  StillBoard still_;  // its corners are sums
};

/// Points near the still boards of one recording.
class Collector {
 public:
  Collector(std::size_t recording, const SE3& T_base_lidar, const Board& board, const cameras::CameraModel& eye,
            const SE3& T_base_camera, const std::vector<StillBoard>& still, std::vector<BoardPose>& poses)
      : recording_(recording),
        T_base_lidar_(T_base_lidar),
        board_(board),
        still_(still),
        poses_(poses),
        eye_(T_base_camera.translation()),
        scans_(still.size()) {
    const SE3 T_base_optical = T_base_camera * cameras::T_camera_optical();
    for (const StillBoard& s : still) {
      const auto T = calibration::board_pose(eye.parameters(), board, s.corners);
      expected_.push_back(T ? std::optional(T_base_optical * *T) : std::nullopt);
    }
  }

  void take(const Scan& scan) {
    for (std::size_t i = 0; i < still_.size(); ++i) {
      const StillBoard& s = still_[i];
      if (s.recording != recording_ || scan.valid.start < s.first || scan.valid.end > s.last || !expected_[i] ||
          scans_[i] == kMostScans)
        continue;
      ++scans_[i];
      calibration::Points points;
      points.reserve(scan.cloud.size());
      for (const Eigen::Vector3f& p : scan.cloud.xyz) points.push_back(T_base_lidar_ * p.cast<double>());
      const auto near = calibration::near_board(points, board_, *expected_[i], eye_, {});
      poses_[i].points.insert(poses_[i].points.end(), near.begin(), near.end());
    }
  }

 private:
  std::size_t recording_;
  SE3 T_base_lidar_;
  Board board_;
  const std::vector<StillBoard>& still_;
  std::vector<BoardPose>& poses_;
  Eigen::Vector3d eye_;
  std::vector<std::size_t> scans_;
  std::vector<std::optional<SE3>> expected_;  // T_base_board
};

}  // namespace

std::vector<StillBoard> find_still(const BoardsFound& found) {
  const double most_motion = std::max(0.5, kMostStillMotion * found.width);
  std::vector<StillBoard> all;
  std::optional<Still> now;
  const auto finish = [&] {
    if (!now) return;
    if (auto still = now->result()) all.push_back(*std::move(still));
  };
  for (const SeenBoard& seen : found.boards) {
    if (now && now->add(seen, most_motion)) continue;
    finish();
    now.emplace(seen);
  }
  finish();
  return all;
}

Result<void> add_scans(const fs::path& recording, std::size_t index, const app::RobotProfile& profile,
                       const Board& board, const cameras::CameraModel& eye, const SE3& T_base_camera,
                       const std::vector<StillBoard>& still, std::vector<BoardPose>& poses) {
  auto reader = recording::RecordingReader::open(recording);
  if (!reader) return reader.error();
  const auto source = lidar_of((*reader)->recording());
  if (!source) return Error{Errc::kNotFound, "the recording lacks a sensor", recording.string(), {}, "a LiDAR"};
  Monitor monitor;
  const auto id = static_cast<SourceId>(*source);
  auto decoder = decoder_of((*reader)->recording().sources[*source], id, profile, monitor);
  if (!decoder) return decoder.error();
  Collector collector(index, profile.robot().T_base_lidar, board, eye, T_base_camera, still, poses);
  for (Packet packet;;) {
    const auto poll = (*reader)->next(packet, {});
    if (!poll || *poll == Poll::kTimeout) continue;
    if (*poll == Poll::kEnd) break;
    if (packet.source != id) continue;
    const auto scan = (*decoder)->decode(packet);
    if (scan && *scan != nullptr) collector.take(**scan);
  }
  if (const Scan* last = (*decoder)->flush()) collector.take(*last);
  return {};
}

}  // namespace cairn::cli
