// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/sweep_import.hpp"

#include <string>
#include <utility>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {

Result<SweepImport> SweepImport::create(const ImportOptions& options, const Description& description) {
  Recording recording;
  recording.robot = options.robot;
  recording.start_utc_ns = description.start_utc_ns;
  recording.notes = description.notes;
  SourceEntry lidar{.id = "lidar", .kind = kScans, .file = "data.csv", .frame = "base_link", .model = options.model};
  // The sweeps' frame is the robot's: no profile's mount may move them away from their ground truth.
  lidar.base_sensor_xyz_rpy = Vector6::Zero();
  lidar.deskewed = options.deskewed.value_or(description.deskewed);
  recording.sources.push_back(std::move(lidar));
  if (!description.camera.empty())
    recording.sources.push_back({"camera", kCamera, "camera/data.csv", "camera", description.camera});
  auto writer = RecordingWriter::create(options.out, recording);
  if (!writer) return writer.error();
  SweepImport import(std::move(*writer), options);
  import.report_.model = options.model;
  return import;
}

Result<void> SweepImport::add(Time end, const PointCloud& cloud, bool with_offset) {
  if (report_.items > 0 && end <= report_.last) {
    damaged({Errc::kMalformed,
             "the sweep does not end after the one before it",
             {},
             {},
             "sweep " + std::to_string(report_.items) + " is left out"});
    return {};
  }
  Packet packet;
  packet.channel = static_cast<std::uint16_t>(with_offset ? ScanLayout::kXyziOffset : ScanLayout::kXyzi);
  packet.arrival = end;
  packet.sequence = report_.items;
  packet.bytes = encode_scan(cloud, with_offset);
  if (auto written = writer_.write(packet); !written) return written;
  if (report_.items++ == 0) report_.first = end;
  report_.last = end;
  report_.bytes += packet.bytes.size();
  if (options_.progress) options_.progress(report_.items);
  if (options_.stop && options_.stop()) return import_interrupted(options_);
  return {};
}

Result<void> SweepImport::add_picture(Time stamp, std::span<const std::byte> file) {
  Packet packet;
  packet.source = SourceId{1};
  packet.arrival = stamp;
  packet.sequence = report_.pictures;
  if (auto made = camera::picture_to_packet(file, camera::FrameFormat::kY16, packet.bytes); !made) return made;
  if (auto written = writer_.write(packet); !written) return written;
  ++report_.pictures;
  return {};
}

void SweepImport::damaged(Error error) {
  if (report_.damaged++ < ImportReport::kMaxDamage) report_.damage.push_back(std::move(error));
}

Result<ImportReport> SweepImport::finish() {
  if (auto closed = writer_.close(); !closed) return closed.error();
  if (report_.items > 0) return std::move(report_);
  const std::string first = report_.damage.empty() ? "" : to_string(report_.damage.front());
  return Error{Errc::kMalformed, "not one sweep could be read", options_.source.string(), {}, first};
}

Result<PointCloud> read_kitti_sweep(const std::filesystem::path& path, std::uint64_t& rejected) {
  constexpr float kFullScale = 255.0F;
  auto bytes = read_file(path, kMaxScanBytes);
  if (!bytes) return bytes.error();
  Packet packet;
  packet.bytes = std::move(*bytes);
  ScanFileDecoder decoder(true);
  const auto scan = decoder.decode(packet);
  if (!scan) return at(path.string(), scan.error());
  rejected += decoder.rejected_points();
  PointCloud cloud = (*scan)->cloud;
  for (float& intensity : cloud.intensity) intensity *= kFullScale;
  return cloud;
}

}  // namespace cairn::recording
