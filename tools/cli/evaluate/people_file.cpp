// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_file.hpp"

#include <cmath>
#include <string>

#include "drivers/recording/formats/text_lines.hpp"
#include "hal/files/file.hpp"

namespace cairn::cli {
namespace {

constexpr std::size_t kColumns = 4, kHeightColumn = 8, kMostColumns = 9;
constexpr std::int64_t kMostIds = 1 << 30;
constexpr std::ptrdiff_t kMostAtOnce = 1000;

Result<PersonRow> parse_row(const recording::LineReader& lines, std::string_view line, bool with_height) {
  std::string_view parts[kMostColumns];
  if (recording::split(line, ',', parts) < kColumns)
    return lines.fault(Errc::kMalformed, "not a person", "t,id,x,y expected");
  const auto ns = recording::parse_seconds(parts[0]);
  const auto id = recording::parse_integer(parts[1]);
  const auto x = recording::parse_number(parts[2]), y = recording::parse_number(parts[3]);
  if (!ns || std::abs(*ns) > kLatest_ns)
    return lines.fault(Errc::kMalformed, "not a time in seconds", std::string(parts[0].substr(0, 40)));
  if (!id || *id < 0 || *id > kMostIds) return lines.fault(Errc::kMalformed, "not an id", "a whole number from 0 on");
  if (!x || !y || std::abs(*x) > kFarthest_m || std::abs(*y) > kFarthest_m)
    return lines.fault(Errc::kMalformed, "not a usable position", "x and y in metres");
  const auto z = with_height ? recording::parse_number(parts[kHeightColumn]) : 0.0;
  if (!z || !(std::abs(*z) <= kFarthest_m))
    return lines.fault(Errc::kMalformed, "not a usable height of the ground", "column z, in metres");
  return PersonRow{Time(Duration(*ns)), *id, {*x, *y}, *z};
}

/// What is wrong with a row after the ones before it, or null.
const char* misplaced(const PersonRow& row, const std::vector<PersonRow>& before) {
  if (!before.empty() && row.stamp < before.back().stamp) return "the times decrease";
  for (auto same = before.rbegin(); same != before.rend() && same->stamp == row.stamp; ++same) {
    if (same->id == row.id) return "an id occurs twice at one time";
    if (same - before.rbegin() >= kMostAtOnce) return "too many people at one time";
  }
  return nullptr;
}

}  // namespace

Result<std::vector<PersonRow>> parse_people(std::string_view text, std::string_view name) {
  recording::LineReader lines(text, name);
  const auto header = lines.next();
  if (!header || !recording::trimmed(*header).starts_with("t,id,x,y"))
    return Error{Errc::kMalformed, "not a table of people", std::string(name), {}, "it begins with t,id,x,y"};
  std::string_view columns[kMostColumns];
  const bool with_height =
      recording::split(recording::trimmed(*header), ',', columns) > kHeightColumn && columns[kHeightColumn] == "z";
  std::vector<PersonRow> rows;
  while (const auto line = lines.next()) {
    if (recording::trimmed(*line).empty()) continue;
    const auto row = parse_row(lines, *line, with_height);
    if (!row) return row.error();
    if (const char* cause = misplaced(*row, rows)) return lines.fault(Errc::kMalformed, cause);
    rows.push_back(*row);
  }
  return rows;
}

Result<std::vector<PersonRow>> read_people(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMaxPeopleBytes);
  if (!bytes) return at(file.string(), bytes.error());
  return parse_people({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string());
}

}  // namespace cairn::cli
