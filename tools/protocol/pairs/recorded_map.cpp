// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/recorded_map.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "drivers/depth/depth_camera.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "hal/monitor.hpp"
#include "hal/workers.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/mapping/mapper.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

/// Where base_link truly was; rests before the first and after the last pose.
class TruePath {
 public:
  explicit TruePath(std::vector<recording::StampedPose> poses) : poses_(std::move(poses)) {}

  [[nodiscard]] Time start() const { return poses_.front().stamp; }
  [[nodiscard]] SE3 at(Time t) const {
    const auto next = std::upper_bound(poses_.begin(), poses_.end(), t,
                                       [](Time when, const recording::StampedPose& p) { return when < p.stamp; });
    if (next == poses_.begin()) return poses_.front().pose;
    if (next == poses_.end()) return poses_.back().pose;
    const auto& [before, from] = *(next - 1);
    const double f = to_seconds(t - before) / to_seconds(next->stamp - before);
    return {from.quaternion().slerp(f, next->pose.quaternion()),
            (1 - f) * from.translation() + f * next->pose.translation()};
  }

 private:
  std::vector<recording::StampedPose> poses_;
};

Result<TruePath> true_path(const fs::path& recording) {
  auto poses = recording::read_tum(recording / "ground_truth.tum");
  if (!poses) return poses.error();
  if (poses->empty()) return Error{Errc::kMalformed, "no true pose", (recording / "ground_truth.tum").string()};
  return TruePath(*std::move(poses));
}

Result<std::unique_ptr<ScanDecoder>> decoder_of(const fs::path& dir, const recording::SourceEntry& entry, SourceId id,
                                                Monitor& monitor) {
  if (entry.kind == recording::kVelodyne) {
    velodyne::Config config;
    config.model = entry.model;
    auto lidar = velodyne::Lidar::create(config, id, monitor);
    if (!lidar) return lidar.error();
    return std::unique_ptr<ScanDecoder>(*std::move(lidar));
  }
  const auto profile = app::load_profile(dir / recording::kProfileFile);
  if (!profile) return profile.error();
  auto camera = depth::DepthCamera::create(profile->depth.driver);
  if (!camera) return camera.error();
  return std::unique_ptr<ScanDecoder>(std::make_unique<depth::DepthCamera>(*std::move(camera)));
}

/// Puts one sensor's scans into a map.
class Placement {
 public:
  Placement(const TruePath& path, const SE3& T_map_world, const SE3& T_base_sensor, const Portion& portion,
            mapping::Mapper& mapper)
      : path_(path), T_map_world_(T_map_world), T_base_sensor_(T_base_sensor), portion_(portion), mapper_(mapper) {}

  Result<void> insert(const Scan& scan) {
    const double start = to_seconds(scan.valid.start - path_.start());
    if (start < portion_.from_s || start >= portion_.to_s || seen_++ % portion_.every != 0) return {};
    points_.clear();
    std::uint32_t offset = 0;
    SE3 T = T_map_sensor(scan.valid.start);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      if (scan.cloud.offset_ns[i] != std::exchange(offset, scan.cloud.offset_ns[i]))
        T = T_map_sensor(scan.valid.start + Duration(offset));
      points_.emplace_back((T * scan.cloud.xyz[i].cast<double>()).cast<float>());
    }
    const Time middle = scan.valid.start + (scan.valid.end - scan.valid.start) / 2;
    const auto inserted = mapper_.insert(points_, T_map_sensor(middle).translation().cast<float>());
    if (!inserted) return inserted.error();
    return {};
  }

 private:
  [[nodiscard]] SE3 T_map_sensor(Time t) const { return T_map_world_ * path_.at(t) * T_base_sensor_; }

  const TruePath& path_;
  SE3 T_map_world_, T_base_sensor_;
  Portion portion_;
  mapping::Mapper& mapper_;
  int seen_ = 0;
  std::vector<Eigen::Vector3f> points_;
};

Result<void> insert_all(Source& source, ScanDecoder& decoder, Placement& placement) {
  for (Packet packet;;) {
    const auto poll = source.next(packet, {});
    if (!poll) return poll.error();
    if (*poll == Poll::kEnd) break;
    if (*poll != Poll::kPacket) continue;
    const auto scan = decoder.decode(packet);
    if (scan && *scan != nullptr)
      if (auto inserted = placement.insert(**scan); !inserted) return inserted;
  }
  if (const Scan* last = decoder.flush()) return placement.insert(*last);
  return {};
}

}  // namespace

Result<SE3> first_true_pose(const fs::path& recording) {
  const auto path = true_path(recording);
  if (!path) return path.error();
  return path->at(path->start());
}

Result<std::shared_ptr<mapping::SemanticOcTree>> map_of_recording(const fs::path& dir, const Portion& portion,
                                                                  const SE3& T_map_world,
                                                                  const mapping::MappingConfig& config) {
  const auto path = true_path(dir);
  if (!path) return path.error();
  const auto recording = recording::load_recording(dir);
  if (!recording) return recording.error();
  const auto entry = std::find_if(recording->sources.begin(), recording->sources.end(),
                                  [&](const recording::SourceEntry& e) { return e.kind == portion.kind; });
  if (entry == recording->sources.end())
    return Error{
        Errc::kNotFound, "no such sensor in the recording", dir.string(), {}, std::string(to_string(portion.kind))};
  const auto index = static_cast<std::size_t>(entry - recording->sources.begin());
  const auto source = recording::open_recorded_source(dir, *recording, index);
  if (!source) return source.error();
  Monitor monitor;
  const auto decoder = decoder_of(dir, *entry, static_cast<SourceId>(index), monitor);
  if (!decoder) return decoder.error();
  Workers workers(1);
  mapping::Mapper mapper(config, workers);
  Placement placement(*path, T_map_world, entry->T_base_sensor(), portion, mapper);
  if (auto inserted = insert_all(**source, **decoder, placement); !inserted) return inserted.error();
  auto map = std::make_shared<mapping::SemanticOcTree>(mapper.tree());
  map->canonicalise();
  return map;
}

}  // namespace cairn::protocol
