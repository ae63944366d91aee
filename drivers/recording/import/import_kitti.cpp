// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/image_folder.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/recording/import/kitti_camera.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "drivers/recording/import/sweep_import.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// The times given, or rate_hz where there are none. Too few times are an error: guessing would bend the trajectory.
Result<std::vector<Time>> times_for(std::size_t sweeps, std::vector<Time> times, double rate_hz,
                                    const fs::path& where) {
  if (!times.empty() && times.size() < sweeps)
    return Error{Errc::kMalformed,
                 "there are more sweeps than times",
                 where.string(),
                 {},
                 std::to_string(sweeps) + " sweeps, " + std::to_string(times.size()) + " times"};
  const auto stuck = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
  if (stuck != times.end())
    return Error{Errc::kMalformed,
                 "the times do not increase",
                 where.string(),
                 {},
                 "from time " + std::to_string(stuck - times.begin()) + " to the next"};
  for (std::size_t i = times.size(); i < sweeps; ++i)
    times.push_back(Time(from_seconds(static_cast<double>(i) / rate_hz)));
  return times;
}

template <class T>
Result<std::vector<T>> read_if_there(const fs::path& path,
                                     Result<std::vector<T>> (*parse)(std::string_view, std::string_view)) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::vector<T>{};
  return read_kitti(path, parse);
}

/// poses_cam0.txt in the sequence folder, or poses/NN.txt beside sequences/NN as the data set is laid out.
Result<std::vector<SE3>> find_poses(const fs::path& sequence) {
  auto beside = read_if_there(sequence / "poses_cam0.txt", parse_kitti_poses);
  if (!beside || !beside->empty()) return beside;
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(sequence, error);
  return read_if_there(folder.parent_path().parent_path() / "poses" / (folder.filename().string() + ".txt"),
                       parse_kitti_poses);
}

/// Poses of cam0 as ground truth of the LiDAR.
Result<std::uint64_t> write_ground_truth(const ImportOptions& options, const std::vector<Time>& times,
                                         const std::vector<SE3>& poses) {
  if (poses.empty()) return 0;
  const auto T_cam_lidar = read_kitti(options.source / "calib.txt", parse_kitti_calibration);
  if (!T_cam_lidar) return T_cam_lidar.error();
  const SE3 T_first_world = T_cam_lidar->inverse() * poses.front().inverse();
  std::vector<StampedPose> truth;
  for (std::size_t i = 0; i < std::min(times.size(), poses.size()); ++i)
    truth.push_back({times[i], T_first_world * poses[i] * *T_cam_lidar});
  if (auto written = write_tum(options.out / "ground_truth.tum", truth); !written) return written.error();
  return truth.size();
}

using PrepareSweep = void (*)(PointCloud& cloud, Duration sweep);

Result<void> add_sweeps(SweepImport& import, const std::vector<fs::path>& files, const std::vector<Time>& ends,
                        Duration sweep, PrepareSweep set_offsets) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto cloud = read_kitti_sweep(files[i], import.report().rejected_points);
    if (!cloud) {
      import.damaged(cloud.error());
      continue;
    }
    if (set_offsets != nullptr) set_offsets(*cloud, sweep);
    if (auto added = import.add(ends[i], *cloud, set_offsets != nullptr); !added) return added;
  }
  return {};
}

/// The sensor turns clockwise from behind: the share of the turn done is 0 behind, 1/4 on the left, 1/2 ahead.
void offsets_from_azimuth(PointCloud& cloud, Duration sweep) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double clockwise = -std::atan2(static_cast<double>(cloud.xyz[i].y()), static_cast<double>(cloud.xyz[i].x()));
    const double share = std::clamp(0.5 * (clockwise / std::numbers::pi + 1.0), 0.0, 1.0);
    cloud.offset_ns[i] = static_cast<std::uint32_t>(std::llround(share * static_cast<double>(sweep.count())));
  }
}

/// The time of each file: that of its number, which is its name; KITTI counts files that are missing, too. Where names
/// are no such numbers, the times in order.
std::vector<Time> times_by_number(const std::vector<fs::path>& files, const std::vector<Time>& times) {
  std::vector<Time> chosen;
  for (const fs::path& file : files) {
    const auto number = parse_integer(file.stem().string());
    if (!number || *number < 0 || static_cast<std::uint64_t>(*number) >= times.size()) return times;
    chosen.push_back(times[static_cast<std::size_t>(*number)]);
  }
  return chosen;
}

/// timestamps_end.txt; or timestamps.txt, when the sensor looked ahead, half a sweep before; or rate_hz.
Result<std::vector<Time>> raw_ends(const fs::path& folder, const std::vector<fs::path>& files, double rate_hz) {
  auto ends = read_if_there(folder / "timestamps_end.txt", parse_kitti_timestamps);
  if (!ends) return ends;
  if (ends->empty()) {
    ends = read_if_there(folder / "timestamps.txt", parse_kitti_timestamps);
    if (!ends) return ends;
    for (Time& t : *ends) t += from_seconds(0.5 / rate_hz);
  }
  return times_for(files.size(), times_by_number(files, *ends), rate_hz, folder);
}

/// The pictures of image_02.
struct Pictures {
  std::vector<fs::path> files;  // as many as stamps
  std::vector<Time> stamps;
};

/// When the sweeps of the same number looked ahead; pictures without a sweep are left out.
Pictures with_sweeps(const std::vector<fs::path>& pictures, const std::vector<fs::path>& sweeps,
                     const std::vector<Time>& ends, double rate_hz) {
  Pictures found;
  for (const fs::path& picture : pictures)
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      if (sweeps[i].stem() != picture.stem()) continue;
      found.files.push_back(picture);
      found.stamps.push_back(ends[i] - from_seconds(0.5 / rate_hz));
      break;
    }
  return found;
}

Result<Pictures> find_pictures(const ImportOptions& options, const std::vector<fs::path>& sweeps,
                               const std::vector<Time>& ends) {
  const fs::path folder = options.source / "image_02";
  std::error_code error;
  if (!fs::exists(folder / "data", error)) return Pictures{};
  const auto files = sorted_files(folder / "data", ".png");
  if (!files) return files.error();
  const auto stamps = read_if_there(folder / "timestamps.txt", parse_kitti_timestamps);
  if (!stamps) return stamps.error();
  if (stamps->empty()) return with_sweeps(*files, sweeps, ends, options.rate_hz);
  auto times = times_for(files->size(), times_by_number(*files, *stamps), options.rate_hz, folder);
  if (!times) return times.error();
  times->resize(files->size());
  return Pictures{.files = *files, .stamps = std::move(*times)};
}

Result<void> add_pictures(SweepImport& import, const Pictures& pictures, const ImportOptions& options) {
  for (std::size_t i = 0; i < pictures.files.size(); ++i) {
    if (options.stop && options.stop()) return import_interrupted(options);
    const auto file = read_file(pictures.files[i], kMaxPictureBytes);
    const Result<void> added = file ? import.add_picture(pictures.stamps[i], *file) : Result<void>(file.error());
    if (!added) import.damaged(at(pictures.files[i].string(), added.error()));
  }
  return {};
}

/// The profile, if there are pictures and their calibration.
Result<void> write_profile(const ImportOptions& options, const Pictures& pictures, ImportReport& report) {
  if (pictures.files.empty()) return {};
  const auto camera = find_kitti_camera(options.source);
  if (!camera) return camera.error();
  if (!*camera) return {};
  const auto file = read_file(pictures.files.front(), kMaxPictureBytes);
  if (!file) return file.error();
  const auto header = camera::parse_picture_header(*file);
  if (!header) return at(pictures.files.front().string(), header.error());
  report.profile = true;
  return write_file_atomic(options.out / kProfileFile,
                           kitti_profile(options.robot, **camera, header->width, header->height, options.rate_hz));
}

}  // namespace

Result<ImportReport> import_kitti_odometry(const ImportOptions& options) {
  const auto files = sorted_files(options.source / "velodyne", ".bin");
  if (!files) return files.error();
  auto times = read_if_there(options.source / "times.txt", parse_kitti_times);
  if (!times) return times.error();
  times = times_for(files->size(), std::move(*times), options.rate_hz, options.source / "times.txt");
  if (!times) return times.error();
  const auto poses = find_poses(options.source);
  if (!poses) return poses.error();

  ImportOptions named = options;
  if (named.model.empty()) named.model = "HDL-64E";
  auto import = SweepImport::create(named, {.deskewed = true, .notes = "imported from a KITTI odometry sequence"});
  if (!import) return import.error();
  const auto written = write_ground_truth(options, *times, *poses);
  if (!written) return written.error();
  import->report().ground_truth_poses = *written;
  if (auto added = add_sweeps(*import, *files, *times, {}, nullptr); !added) return added.error();
  return import->finish();
}

Result<ImportReport> import_kitti_raw(const ImportOptions& options) {
  const fs::path folder = options.source / "velodyne_points";
  const auto files = sorted_files(folder / "data", ".bin");
  if (!files) return files.error();
  const auto ends = raw_ends(folder, *files, options.rate_hz);
  if (!ends) return ends.error();
  const auto pictures = find_pictures(options, *files, *ends);
  if (!pictures) return pictures.error();

  ImportOptions named = options;
  if (named.model.empty()) named.model = "HDL-64E";
  auto import = SweepImport::create(named, {.notes = "imported from a KITTI raw drive; firing times from the azimuth",
                                            .start_utc_ns = ends->front().time_since_epoch().count(),
                                            .camera = pictures->files.empty() ? "" : "image_02"});
  if (!import) return import.error();
  if (auto written = write_profile(options, *pictures, import->report()); !written) return written.error();
  if (auto added = add_sweeps(*import, *files, *ends, from_seconds(1.0 / options.rate_hz), offsets_from_azimuth);
      !added)
    return added.error();
  if (auto added = add_pictures(*import, *pictures, options); !added) return added.error();
  return import->finish();
}

}  // namespace cairn::recording
