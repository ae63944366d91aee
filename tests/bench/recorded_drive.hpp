// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/drive/wheel_decoder.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "hal/drive.hpp"
#include "hal/point_cloud.hpp"
#include "hal/se3.hpp"
#include "tools/simulator/sensors/motor_bus.hpp"

namespace cairn::bench {

/// The scans of a recording, with truth and wheels. A recording without ground_truth.tum is taken to stand.
struct RecordedDrive {
  std::string name;
  SE3 T_base_lidar;
  std::vector<Scan> scans;
  std::vector<SE3> truth;                         // T_world_base at each scan's end
  std::vector<std::optional<DriveState>> wheels;  // newest at each scan's end
};

/// Poses of ground_truth.tum, interpolated.
class Truth {
 public:
  explicit Truth(const std::filesystem::path& file) {
    if (std::filesystem::exists(file)) poses_ = recording::read_tum(file).value();
  }
  [[nodiscard]] SE3 operator()(Time t) const {
    const auto after = std::ranges::lower_bound(poses_, t, {}, [](const auto& p) { return p.stamp; });
    if (poses_.empty()) return {};
    if (after == poses_.begin()) return poses_.front().pose;
    if (after == poses_.end()) return poses_.back().pose;
    const auto& before = *(after - 1);
    const double share = to_seconds(t - before.stamp) / to_seconds(after->stamp - before.stamp);
    return before.pose * SE3::exp(share * (before.pose.inverse() * after->pose).log());
  }

 private:
  std::vector<recording::StampedPose> poses_;
};

inline void deskew_with(const Truth& truth, const SE3& T_base_lidar, Scan& scan) {
  const SE3 T_lidar_world = (truth(scan.valid.end) * T_base_lidar).inverse();
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Time fired = scan.valid.start + Duration(scan.cloud.offset_ns[i]);
    const SE3 motion = T_lidar_world * truth(fired) * T_base_lidar;
    scan.cloud.xyz[i] = (motion * scan.cloud.xyz[i].cast<double>()).cast<float>();
  }
  scan.deskewed = true;
  scan.cloud.offset_ns.clear();
}

/// Scan `n` of a LiDAR of 10 Hz falls into a gap.
inline bool in_a_gap(int n, double gap_s) {
  constexpr int kFirst = 80, kPeriod = 120;
  return n >= kFirst && (n - kFirst) % kPeriod < static_cast<int>(10 * gap_s);
}

/// What of a recording is left out.
struct Thinning {
  int every = 1;          ///< keeps every N-th scan only, as key frames come
  double gap_s = 0;       ///< see in_a_gap()
  bool deskewed = false;  ///< deskews with the truth and takes away the firing times
  bool wheels = true;     ///< keeps the wheels
};

inline RecordedDrive load(const std::filesystem::path& folder, const Thinning& thinning) {
  auto reader = recording::RecordingReader::open(folder).value();
  const auto& source = reader->recording().sources.front();
  RecordedDrive out{
      folder.parent_path().filename().string() + "/" + folder.filename().string(), source.T_base_sensor(), {}, {}, {}};
  Monitor monitor;
  const auto lidar = velodyne::Lidar::create({}, SourceId{}, monitor).value();
  const auto wheels = drive::WheelDecoder::create(simulator::husky_drive()).value();
  std::optional<DriveState> rolled;
  const Truth truth(folder / "ground_truth.tum");
  Packet packet;
  int n = 0;
  bool begun = false;
  while (true) {
    const auto poll = reader->next(packet, Duration::zero());
    if (!poll || *poll == Poll::kEnd) break;
    if (const auto& kind = reader->recording().sources[static_cast<std::size_t>(packet.source)].kind;
        kind == recording::kDrive) {
      if (const auto state = wheels->decode(packet); state && *state != nullptr) rolled = **state;
    }
    if (packet.source != SourceId{0}) continue;
    const auto scan = lidar->decode(packet);
    if (!scan || *scan == nullptr) continue;
    if (!std::exchange(begun, true) && (*scan)->incomplete) continue;  // a robot leaves it out, too
    if (n++ % thinning.every != 0 || in_a_gap(n, thinning.gap_s)) continue;
    out.scans.push_back(**scan);
    out.truth.push_back(truth((*scan)->valid.end));
    out.wheels.push_back(thinning.wheels ? rolled : std::nullopt);
    if (thinning.deskewed) deskew_with(truth, out.T_base_lidar, out.scans.back());
  }
  return out;
}

}  // namespace cairn::bench
