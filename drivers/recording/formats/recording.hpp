// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/recording/formats/sensor_kind.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::recording {

/// One source of a recording. Its index in Recording::sources is the SourceId of its packets.
struct SourceEntry {
  std::string id;     ///< unique in the recording: letters, digits, `_`, `-`, `.`
  SensorKind kind{};  ///< decides how `file` is read
  std::string file;   ///< relative to the recording's folder, with `/`; never absolute, never with `..`
  std::string frame;  ///< frame of the sensor (REP-105 style, such as `lidar`)
  std::string model;  ///< the sensor (`VLP-16`, `lepton3`, …), the drive's protocol, or what recorded it; may be empty
  /// T_base_sensor as x y z roll pitch yaw (metres, radians, fixed axes); kept as numbers so that files keep their
  /// bits.
  std::optional<Vector6> base_sensor_xyz_rpy{};
  std::uint16_t data_port = 2368;      ///< velodyne: UDP port of the data packets
  std::uint16_t position_port = 8308;  ///< velodyne: UDP port of the position packets
  bool deskewed = false;               ///< scans: the motion is compensated already (KITTI)

  /// Pose of the sensor in base_link; identity if the recording has none.
  [[nodiscard]] SE3 T_base_sensor() const {
    return base_sensor_xyz_rpy ? SE3::from_xyz_rpy(*base_sensor_xyz_rpy) : SE3();
  }
};

/// The content of recording.yaml. Stamps in pcap and candump files are UTC. On the robot's monotonic time line, Time =
/// UTC − realtime_offset. Simulated and imported recordings may have an offset of zero.
struct Recording {
  std::string robot;                    ///< letters, digits, `_`, `-`, `.`
  std::string profile;                  ///< robot profile it was made with; may be empty
  std::int64_t start_utc_ns = 0;        ///< wall time of the start, nanoseconds since 1970; metadata only
  std::int64_t realtime_offset_ns = 0;  ///< CLOCK_REALTIME − CLOCK_MONOTONIC at the start
  std::int64_t time_shift_ns = 0;       ///< how much later its times are than in the recording that was played for it
  std::vector<SourceEntry> sources;
  std::string notes;
  bool unfinished = false;  ///< it is still written, or its program was killed: its end may be missing

  /// Nanoseconds since 1970.
  [[nodiscard]] std::int64_t utc_ns(Time t) const { return t.time_since_epoch().count() + realtime_offset_ns; }
};

inline constexpr const char* kIndexFile = "recording.yaml";
/// The profile of the robot that made it, beside the index; a recording may lack it.
inline constexpr const char* kProfileFile = "profile.yaml";
inline constexpr std::size_t kMaxSources = 64;
/// UTC stamps, offsets and times are at most this far from zero (the year 2043), so that sums of two cannot overflow.
inline constexpr std::int64_t kMaxUtcNs = (std::int64_t{1} << 61) - 1;

/// Reads `dir`/recording.yaml and checks that every source's file is a regular file inside `dir`. All faults (unknown
/// or repeated keys, wrong kinds, missing files, paths that leave the folder) come in one Error, one line each:
/// "file:line: key: cause".
[[nodiscard]] Result<Recording> load_recording(const std::filesystem::path& dir);

/// What is to be said of the unfinished recording in `dir`: the cause, and the remedy as `detail`.
[[nodiscard]] Error unfinished_recording(const std::filesystem::path& dir);

/// Writes `dir`/recording.yaml (atomically); `dir` must exist. Refuses what load_recording would refuse, except that
/// the files of the sources need not exist yet.
[[nodiscard]] Result<void> save_recording(const std::filesystem::path& dir, const Recording& recording);

/// What is wrong with the file of a source, or nothing.
using FileCheck = std::function<std::optional<Error>(std::string_view file)>;
/// The text of recording.yaml; `name` is used in messages, `check_file` is asked about each well-formed file name.
[[nodiscard]] Result<Recording> parse_recording(std::string_view yaml, std::string_view name,
                                                const FileCheck& check_file = {});
[[nodiscard]] std::string to_yaml(const Recording& recording);

/// Why `file` may not be named in a recording (absolute, `..`, empty, odd characters); null when it may.
[[nodiscard]] const char* path_fault(std::string_view file);
/// `dir`/`file` when that is an existing regular file inside `dir`, symbolic links followed; otherwise an Error.
[[nodiscard]] Result<std::filesystem::path> resolve_inside(const std::filesystem::path& dir, std::string_view file);

}  // namespace cairn::recording
