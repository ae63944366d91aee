// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "drivers/recording/import/sweep_import.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// A file name that is a time: whole nanoseconds of at least 16 digits, or seconds with a point.
std::optional<Time> time_in_name(const fs::path& file) {
  const std::string name = file.stem().string();
  const bool nanoseconds = name.size() >= 16 && name.find('.') == std::string::npos;
  if (!nanoseconds && name.find('.') == std::string::npos) return std::nullopt;
  const auto ns = nanoseconds ? parse_integer(name) : parse_seconds(name);
  if (!ns || *ns < 0 || *ns > kMaxUtcNs) return std::nullopt;
  return Time(Duration(*ns));
}

/// The times in the names when every name is one and they increase; otherwise nothing.
std::vector<Time> times_in_names(const std::vector<fs::path>& files) {
  std::vector<Time> times;
  for (const fs::path& file : files) {
    const auto time = time_in_name(file);
    if (!time || (!times.empty() && *time <= times.back())) return {};
    times.push_back(*time);
  }
  return times;
}

Result<PcdCloud> read_pcd(const fs::path& file) {
  const auto bytes = read_file(file, kMaxPcdBytes);
  if (!bytes) return bytes.error();
  return parse_pcd(*bytes, file.string());
}

}  // namespace

Result<ImportReport> import_pcd_folder(const ImportOptions& options) {
  const auto files = sorted_files(options.source, ".pcd");
  if (!files) return files.error();
  const std::vector<Time> named = times_in_names(*files);
  const std::int64_t start = named.empty() ? 0 : named.front().time_since_epoch().count();
  auto import = SweepImport::create(options, {.notes = "imported from PCD files", .start_utc_ns = start});
  if (!import) return import.error();
  for (std::size_t i = 0; i < files->size(); ++i) {
    const auto pcd = read_pcd((*files)[i]);
    if (!pcd) {
      import->damaged(pcd.error());
      continue;
    }
    import->report().rejected_points += pcd->rejected;
    Time end = named.empty() ? Time(from_seconds(static_cast<double>(i) / options.rate_hz)) : named[i];
    if (pcd->end_utc_ns) end = Time(Duration(*pcd->end_utc_ns));
    if (auto added = import->add(end, pcd->cloud, pcd->has_time); !added) return added.error();
  }
  return import->finish();
}

}  // namespace cairn::recording
