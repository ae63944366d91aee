// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/trajectory_file.hpp"

#include <charconv>
#include <cmath>

#include "drivers/recording/formats/text_lines.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

constexpr double kMaxMetres = 1e9;
constexpr double kUnitTolerance = 0.05;  // files written with few digits are still meant to be rotations

void append_seconds(std::string& out, Time stamp) {
  const std::int64_t ns = stamp.time_since_epoch().count();
  // Unsigned, because the smallest integer has no positive counterpart.
  const auto size = ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  const std::string fraction = std::to_string(size % 1'000'000'000);
  out += (ns < 0 ? "-" : "") + std::to_string(size / 1'000'000'000) + "." + std::string(9 - fraction.size(), '0') +
         fraction;
}

void append_number(std::string& out, double value) {
  char buffer[40];
  const double plain = value + 0.0;  // no negative zero
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), plain, std::chars_format::general, 12).ptr;
  out += ' ';
  out.append(std::begin(buffer), end);
}

Result<StampedPose> parse_pose(const LineReader& lines, std::string_view line) {
  std::string_view parts[8];
  if (split(line, ' ', parts) != 8)
    return lines.fault(Errc::kMalformed, "not a pose", "eight numbers expected: t tx ty tz qx qy qz qw");
  const auto ns = parse_seconds(parts[0]);
  if (!ns) return lines.fault(Errc::kMalformed, "not a time in seconds", std::string(parts[0].substr(0, 40)));
  double value[7];
  for (int i = 0; i < 7; ++i) {
    const auto number = parse_number(parts[i + 1]);
    if (!number || std::abs(*number) > kMaxMetres)
      return lines.fault(Errc::kMalformed, "not a usable number", std::string(parts[i + 1].substr(0, 40)));
    value[i] = *number;
  }
  const Eigen::Quaterniond q(value[6], value[3], value[4], value[5]);
  if (!(std::abs(q.norm() - 1.0) <= kUnitTolerance))
    return lines.fault(Errc::kMalformed, "the quaternion has no unit length", std::to_string(q.norm()));
  return StampedPose{Time(Duration(*ns)), SE3(q, Eigen::Vector3d(value[0], value[1], value[2]))};
}

}  // namespace

Result<void> parse_tum(std::string_view text, std::string_view name, std::vector<StampedPose>& poses) {
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || content.front() == '#') continue;
    auto pose = parse_pose(lines, content);
    if (!pose) return pose.error();
    if (!poses.empty() && pose->stamp <= poses.back().stamp)
      return lines.fault(Errc::kMalformed, "the stamps do not increase");
    poses.push_back(*pose);
  }
  return {};
}

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxTrajectoryBytes);
  if (!bytes) return bytes.error();
  std::vector<StampedPose> poses;
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (auto parsed = parse_tum(text, path.string(), poses); !parsed) return parsed.error();
  return poses;
}

std::string to_tum(std::span<const StampedPose> poses) {
  std::string out;
  for (const StampedPose& p : poses) {
    append_seconds(out, p.stamp);
    const Eigen::Quaterniond& q = p.pose.quaternion();
    const double sign = q.w() < 0 ? -1.0 : 1.0;
    for (const double v : {p.pose.translation().x(), p.pose.translation().y(), p.pose.translation().z(), sign * q.x(),
                           sign * q.y(), sign * q.z(), sign * q.w()})
      append_number(out, v);
    out += '\n';
  }
  return out;
}

Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses) {
  return write_file_atomic(path, to_tum(poses));
}

}  // namespace cairn::recording
