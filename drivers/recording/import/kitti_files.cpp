// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/kitti_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>
#include <tuple>

#include "drivers/recording/formats/text_lines.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxTextBytes = std::uint64_t{64} << 20U;
constexpr double kMaxMetres = 1e6;
constexpr double kRotationTolerance = 0.01;

/// For sorting: 9 before 10, with or without leading zeros; names that are no numbers come after them.
std::tuple<std::size_t, std::string, std::string> natural_order(const fs::path& file) {
  const std::string name = file.stem().string();
  if (name.find_first_not_of("0123456789") != std::string::npos) return {std::string::npos, name, name};
  const std::string digits = name.substr(std::min(name.find_first_not_of('0'), name.size()));
  return {digits.size(), digits, name};
}

/// Twelve numbers of which nine are a rotation.
Result<SE3> parse_transform(const LineReader& lines, std::string_view text) {
  std::string_view parts[12];
  if (split(text, ' ', parts) != 12) return lines.fault(Errc::kMalformed, "a 3x4 transform has twelve numbers");
  Eigen::Matrix<double, 3, 4> m;
  for (int i = 0; i < 12; ++i) {
    const auto value = parse_number(parts[i]);
    if (!value || std::abs(*value) > kMaxMetres)
      return lines.fault(Errc::kMalformed, "not a usable number", std::string(parts[i].substr(0, 40)));
    m(i / 4, i % 4) = *value;
  }
  const Eigen::Matrix3d R = m.leftCols<3>();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= kRotationTolerance) || R.determinant() < 0)
    return lines.fault(Errc::kMalformed, "the 3x3 part is not a rotation");
  return SE3(R, Eigen::Vector3d(m.col(3)));
}

/// One item a line, empty lines apart.
template <class T, class Parse>
Result<std::vector<T>> parse_lines(std::string_view text, std::string_view name, Parse parse) {
  std::vector<T> items;
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    Result<T> item = parse(lines, trimmed(*line));
    if (!item) return item.error();
    items.push_back(*item);
  }
  return items;
}

}  // namespace

Result<SE3> parse_kitti_calibration(std::string_view text, std::string_view name) {
  LineReader lines(text, name);
  while (const auto line = lines.next())
    if (line->starts_with("Tr:")) return parse_transform(lines, line->substr(3));
  return Error{Errc::kNotFound, "the calibration has no line `Tr:`", std::string(name), {}, {}};
}

Result<std::vector<SE3>> parse_kitti_poses(std::string_view text, std::string_view name) {
  return parse_lines<SE3>(text, name, parse_transform);
}

Result<std::vector<Time>> parse_kitti_times(std::string_view text, std::string_view name) {
  return parse_lines<Time>(text, name, [](const LineReader& lines, std::string_view line) -> Result<Time> {
    const auto ns = parse_seconds(line);
    if (!ns) return lines.fault(Errc::kMalformed, "not a time in seconds", std::string(line.substr(0, 40)));
    return Time(Duration(*ns));
  });
}

Result<std::vector<Time>> parse_kitti_timestamps(std::string_view text, std::string_view name) {
  return parse_lines<Time>(text, name, [](const LineReader& lines, std::string_view line) -> Result<Time> {
    const auto ns = parse_iso_utc(line);
    if (!ns) return lines.fault(Errc::kMalformed, "not a date and time", std::string(line.substr(0, 40)));
    return Time(Duration(*ns));
  });
}

Result<std::vector<fs::path>> sorted_files(const fs::path& folder, std::string_view extension) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().extension() == extension && entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error) return Error{Errc::kNotFound, "cannot read the folder", folder.string(), {}, error.message()};
  if (files.empty())
    return Error{Errc::kNotFound, "the folder holds no such files", folder.string(), {}, "*" + std::string(extension)};
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return natural_order(a) < natural_order(b); });
  return files;
}

Result<std::string> read_text(const fs::path& path) {
  const auto bytes = read_file(path, kMaxTextBytes);
  if (!bytes) return bytes.error();
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace cairn::recording
