// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/recording/new_recording.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "drivers/recording/stamp_guard.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// Foreign data → recording. Everything is copied, nothing linked; one packet or sweep is in memory at a time.
namespace cairn::recording {

/// What to import, and what the data itself does not say.
struct ImportOptions {
  std::filesystem::path source;    ///< the file or folder to import
  std::filesystem::path out;       ///< folder of the new recording
  std::string robot = "robot";     ///< name of the robot
  std::string model;               ///< of the sensor; empty: found out, or left open
  double rate_hz = 10;             ///< of sweeps that carry no time
  std::optional<bool> deskewed{};  ///< overrides what is known about the data set
  std::uint16_t data_port = 2368;  ///< velodyne-pcap: UDP destination ports to look for
  std::uint16_t position_port = 8308;
  Overwrite overwrite = Overwrite::kNo;
  std::function<void(std::uint64_t items)> progress{};  ///< called after every packet or sweep
  std::function<bool()> stop{};  ///< asked after every packet or sweep: whether to give up; empty: never
};

/// The error of an import that `stop` ended.
[[nodiscard]] Error import_interrupted(const ImportOptions& options);

/// The result of an import.
struct ImportReport {
  std::uint64_t items = 0;            ///< packets or sweeps written
  std::uint64_t bytes = 0;            ///< of their payload
  std::uint64_t rejected_points = 0;  ///< not finite or out of any range
  std::uint64_t ground_truth_poses = 0;
  std::uint64_t pictures = 0;  ///< of the camera
  bool profile = false;        ///< the recording has a profile, with the calibration that came with the data
  std::string model;
  Time first{}, last{};       ///< arrival of the first and last item whose stamp is not absurd
  std::vector<Error> damage;  ///< parts that could not be read, at most kMaxDamage; the good parts are in the recording
  std::uint64_t damaged = 0;  ///< how many parts could not be read
  /// Packets with absurd stamps. They are in the recording as they were; whoever reads it sets them aside.
  StampGuard::Found absurd_stamps;
  std::optional<Error> absurd_stamps_note;  ///< the same in words, with the remedy
  static constexpr std::size_t kMaxDamage = 16;
};

/// Copies the Velodyne datagrams (data and position port) out of any pcap or pcapng file, byte for byte, with their
/// capture stamps as UTC. `options.source` is the file.
[[nodiscard]] Result<ImportReport> import_velodyne_pcap(const ImportOptions& options);

/// KITTI odometry: a sequence folder (velodyne/*.bin and, where present, calib.txt with Tr, times.txt and
/// poses_cam0.txt or ../../poses/NN.txt). Intensity 0…1 becomes 0…255; the sweeps are motion-compensated. Poses of the
/// left camera become ground_truth.tum of base_link, which is the LiDAR's frame, in the frame of the first sweep: T_0_i
/// = Tr⁻¹·P_0⁻¹·P_i·Tr. (https://www.cvlibs.net/datasets/kitti/eval_odometry.php)
[[nodiscard]] Result<ImportReport> import_kitti_odometry(const ImportOptions& options);

/// KITTI raw: a drive folder with velodyne_points/{data/*.bin, timestamps.txt, timestamps_end.txt}. The sweeps are not
/// motion-compensated; firing times follow from the azimuth, as the sensor turns clockwise from behind. Where there is
/// image_02/data, its pictures come along, at their timestamps.txt or else when the sweep of the same number looked
/// ahead. With the calibration (kitti_camera.hpp), the recording gets a profile: intrinsics and mounts.
[[nodiscard]] Result<ImportReport> import_kitti_raw(const ImportOptions& options);

/// A folder of *.pcd files in the order of their names. The time of a sweep is that of its points where they are
/// absolute, otherwise its name where all are times (nanoseconds, or seconds with a point), otherwise rate_hz.
[[nodiscard]] Result<ImportReport> import_pcd_folder(const ImportOptions& options);

/// `velodyne-pcap`, `kitti-odometry`, `kitti-raw` or `pcd-folder`. The recording appears when it is whole: an error
/// leaves nothing at `options.out`, and what was there stays. The functions above write into an empty folder instead.
[[nodiscard]] Result<ImportReport> import(std::string_view kind, const ImportOptions& options);
[[nodiscard]] const std::vector<std::string>& import_kinds();

}  // namespace cairn::recording
