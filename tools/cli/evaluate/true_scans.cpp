// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/true_scans.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "drivers/velodyne/packet.hpp"
#include "hal/files/file.hpp"
#include "hal/monitor.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReturns = std::size_t{velodyne::kBlocks} * velodyne::kBlockChannels;
constexpr std::uint64_t kMostLabelBytes = std::uint64_t{1} << 30U;  // an hour of a VLP-16
constexpr Duration kSamePose = std::chrono::microseconds(200);      // the robot moves by less than a millimetre

/// Puts the classes of a data packet where the sensor says how bright a return is, so that they pass the decoder.
void hide_classes(std::vector<std::byte>& packet, std::span<const std::byte> classes) {
  for (std::size_t i = 0; i < classes.size(); ++i)
    packet[i / velodyne::kBlockChannels * velodyne::kBlockBytes + velodyne::kBlockReturnsOffset +
           i % velodyne::kBlockChannels * velodyne::kReturnBytes + 2] = classes[i];
}

Result<SourceId> find_lidar(const recording::Recording& recording, const fs::path& folder) {
  for (std::size_t i = 0; i < recording.sources.size(); ++i)
    if (recording.sources[i].kind == recording::kVelodyne) return static_cast<SourceId>(i);
  return Error{Errc::kNotFound, "the recording lacks a sensor", folder.string(), {}, "a Velodyne LiDAR"};
}

/// Gives each data packet its part of lidar_labels.bin.
class ReturnClasses {
 public:
  static Result<ReturnClasses> read(const fs::path& folder) {
    const fs::path file = folder / "lidar_labels.bin";
    auto bytes = read_file(file, kMostLabelBytes);
    if (bytes) return ReturnClasses(file, *std::move(bytes));
    if (bytes.error().code != Errc::kNotFound) return at(file.string(), bytes.error());
    return Error{Errc::kNotFound,
                 "the recording does not say what the LiDAR's returns met",
                 file.string(),
                 {},
                 "take a recording of `cairn simulate` with --people or a camera"};
  }

  /// False: the file has ended.
  bool hide_in(std::vector<std::byte>& packet) {
    if (next_ + kReturns > bytes_.size()) return false;
    hide_classes(packet, std::span(bytes_).subspan(next_, kReturns));
    next_ += kReturns;
    return true;
  }
  [[nodiscard]] bool at_end() const { return next_ == bytes_.size(); }
  [[nodiscard]] Error misfit() const {
    return {Errc::kMalformed,
            "the file has another number of returns than the LiDAR's recording",
            file_.string(),
            {},
            std::to_string(bytes_.size()) + " bytes"};
  }

 private:
  ReturnClasses(fs::path file, std::vector<std::byte> bytes) : file_(std::move(file)), bytes_(std::move(bytes)) {}

  fs::path file_;
  std::vector<std::byte> bytes_;
  std::size_t next_ = 0;
};

/// Moves sweeps into the frame of the path.
class Placer {
 public:
  Placer(const Path& path, const SE3& T_base_lidar) : path_(path), T_base_lidar_(T_base_lidar) {}

  const TrueScan& place(const Scan& scan) {
    scan_.stamp = scan.valid.end;
    scan_.T_path_base = path_.at(scan.valid.end);
    scan_.T_path_lidar = scan_.T_path_base * T_base_lidar_;
    scan_.returns.clear();
    Eigen::Isometry3f T_path_lidar;
    std::optional<Time> posed;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const Time fired = scan.valid.start + Duration(scan.cloud.offset_ns[i]);
      if (!posed || std::chrono::abs(fired - *posed) > kSamePose) {
        T_path_lidar = Eigen::Isometry3f((path_.at(fired) * T_base_lidar_).matrix().cast<float>());
        posed = fired;
      }
      const Eigen::Vector3f& p = scan.cloud.xyz[i];
      scan_.returns.push_back({.point = T_path_lidar * p,
                               .range_m = p.norm(),
                               .class_id = static_cast<std::uint8_t>(scan.cloud.intensity[i])});
    }
    return scan_;
  }

 private:
  const Path& path_;
  SE3 T_base_lidar_;
  TrueScan scan_;
};

}  // namespace

Result<void> for_each_true_scan(const fs::path& folder, const app::RobotProfile& profile, const Path& path,
                                const std::function<void(const TrueScan&)>& use) {
  auto reader = recording::RecordingReader::open(folder);
  if (!reader) return at(folder.string(), reader.error());
  const auto id = find_lidar((*reader)->recording(), folder);
  if (!id) return id.error();
  auto classes = ReturnClasses::read(folder);
  if (!classes) return classes.error();
  Monitor monitor;
  const auto lidar = velodyne::Lidar::create(profile.lidar.driver, *id, monitor);
  if (!lidar) return lidar.error();
  Placer placer(path, profile.robot().T_base_lidar);
  for (Packet packet;;) {
    const auto poll = (*reader)->next(packet, {});
    if (!poll) return at(folder.string(), poll.error());
    if (*poll == Poll::kEnd) break;
    if (*poll != Poll::kPacket || packet.source != *id) continue;
    if (packet.bytes.size() == velodyne::kDataBytes && !classes->hide_in(packet.bytes)) return classes->misfit();
    const auto scan = (*lidar)->decode(packet);
    if (scan && *scan != nullptr) use(placer.place(**scan));
  }
  if (!classes->at_end()) return classes->misfit();
  if (const Scan* last = (*lidar)->flush()) use(placer.place(*last));
  return {};
}

}  // namespace cairn::cli
