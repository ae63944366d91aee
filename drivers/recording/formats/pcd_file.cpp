// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/pcd_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "hal/bytes.hpp"

namespace cairn::recording {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxMetres = 1e4, kMaxSweepSeconds = 2.0, kAbsoluteSeconds = 1e8, kSurelyNanoseconds = 1e14;

enum Column : std::size_t { kX, kY, kZ, kIntensity, kRing, kTime, kColumns };
using Row = std::array<double, kColumns>;

/// The fields that matter, null where the file has none.
using Chosen = std::array<const PcdField*, kColumns>;

Chosen choose(const PcdHeader& header) {
  const auto first_of = [&](std::initializer_list<std::string_view> names) -> const PcdField* {
    for (const std::string_view name : names)
      if (const PcdField* field = header.field(name); field != nullptr) return field;
    return nullptr;
  };
  return {first_of({"x"}),    first_of({"y"}),
          first_of({"z"}),    first_of({"intensity", "reflectivity"}),
          first_of({"ring"}), first_of({"time", "t", "timestamp"})};
}

template <class T>
double load_as_double(std::span<const std::byte> bytes, std::size_t at) {
  return static_cast<double>(load_le<T>(bytes, at));
}

double value_at(std::span<const std::byte> point, const PcdField& f) {
  switch (f.type == 'F' ? f.size : f.size + (f.type == 'I' ? 10 : 20)) {
    case 4:
      return load_as_double<float>(point, f.offset);
    case 8:
      return load_as_double<double>(point, f.offset);
    case 11:
      return load_as_double<std::int8_t>(point, f.offset);
    case 12:
      return load_as_double<std::int16_t>(point, f.offset);
    case 14:
      return load_as_double<std::int32_t>(point, f.offset);
    case 18:
      return load_as_double<std::int64_t>(point, f.offset);
    case 21:
      return load_as_double<std::uint8_t>(point, f.offset);
    case 22:
      return load_as_double<std::uint16_t>(point, f.offset);
    case 24:
      return load_as_double<std::uint32_t>(point, f.offset);
    default:
      return load_as_double<std::uint64_t>(point, f.offset);
  }
}

Result<std::vector<Row>> binary_rows(std::span<const std::byte> data, const PcdHeader& h, const Chosen& chosen,
                                     std::string_view name) {
  const std::size_t there = data.size() / h.point_bytes;
  if (there < h.points)
    return Error{Errc::kTruncated, "the file ends before its last point", std::string(name),
                 h.data_offset + data.size(), std::to_string(there) + " of " + std::to_string(h.points) + " points"};
  std::vector<Row> rows(h.points);
  for (std::size_t i = 0; i < h.points; ++i) {
    const auto point = data.subspan(i * h.point_bytes, h.point_bytes);
    for (std::size_t c = 0; c < kColumns; ++c) rows[i][c] = chosen[c] != nullptr ? value_at(point, *chosen[c]) : 0.0;
  }
  return rows;
}

/// Which column of the text each chosen field begins at.
std::array<std::size_t, kColumns> text_columns(const PcdHeader& h, const Chosen& chosen) {
  std::array<std::size_t, kColumns> columns{};
  for (std::size_t c = 0; c < kColumns; ++c)
    for (const PcdField& f : h.fields) {
      if (&f == chosen[c]) break;
      columns[c] += f.count;
    }
  return columns;
}

Result<std::vector<Row>> ascii_rows(std::string_view text, const PcdHeader& h, const Chosen& chosen,
                                    std::string_view name) {
  const auto columns = text_columns(h, chosen);
  LineReader lines(text, name);
  std::vector<Row> rows;
  for (auto line = lines.next(); line && rows.size() < h.points; line = lines.next()) {
    std::string_view rest = trimmed(*line);
    if (rest.empty()) continue;
    Row row{};
    std::size_t wanted = 0;
    for (std::size_t column = 0; !rest.empty(); ++column) {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      for (std::size_t c = 0; c < kColumns; ++c) {
        if (chosen[c] == nullptr || columns[c] != column) continue;
        row[c] = parse_number(rest.substr(0, end)).value_or(kNan);
        ++wanted;
      }
      rest = trimmed(rest.substr(end));
    }
    if (wanted !=
        static_cast<std::size_t>(std::count_if(chosen.begin(), chosen.end(), [](auto* f) { return f != nullptr; })))
      return lines.fault(Errc::kMalformed, "a point has too few values", "counted from the DATA line");
    rows.push_back(row);
  }
  if (rows.size() < h.points)
    return Error{Errc::kTruncated, "the file ends before its last point", std::string(name),
                 h.data_offset + text.size(),
                 std::to_string(rows.size()) + " of " + std::to_string(h.points) + " points"};
  return rows;
}

bool usable(const Row& row) {
  return std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); }) &&
         std::abs(row[kX]) <= kMaxMetres && std::abs(row[kY]) <= kMaxMetres && std::abs(row[kZ]) <= kMaxMetres &&
         std::abs(row[kIntensity]) <= 1e9;
}

/// Seconds per unit of the time column: integers are nanoseconds, floats seconds unless they are too large for that.
double time_unit(const PcdField& field, double latest) {
  return field.type != 'F' || std::abs(latest) > kSurelyNanoseconds ? 1e-9 : 1.0;
}

Result<PcdCloud> to_cloud(std::vector<Row> rows, const PcdField* time, std::string_view name) {
  PcdCloud out;
  out.rejected = std::erase_if(rows, [](const Row& row) { return !usable(row); });
  const auto [first, last] =
      std::minmax_element(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a[kTime] < b[kTime]; });
  const double start = rows.empty() ? 0 : (*first)[kTime], end = rows.empty() ? 0 : (*last)[kTime];
  const double unit = time != nullptr ? time_unit(*time, end) : 1.0;
  if (!((end - start) * unit <= kMaxSweepSeconds))
    return Error{Errc::kMalformed, "the points' times spread over more than two seconds", std::string(name), {}, {}};
  out.has_time = time != nullptr;
  if (start * unit >= kAbsoluteSeconds && end * unit * 1e9 < static_cast<double>(kMaxUtcNs))
    out.end_utc_ns = from_seconds(end * unit).count();
  out.cloud.reserve(rows.size());
  for (const Row& r : rows) {
    const auto offset = static_cast<std::uint32_t>(from_seconds((r[kTime] - start) * unit).count());
    const double ring = std::clamp(r[kRing], 0.0, 255.0);
    out.cloud.push_back(Eigen::Vector3d(r[kX], r[kY], r[kZ]).cast<float>(), static_cast<float>(r[kIntensity]), offset,
                        static_cast<std::uint8_t>(ring), ReturnType::kStrongest);
  }
  return out;
}

/// `columns`: the lines that describe them.
std::vector<std::byte> header_of(const std::string& columns, std::size_t points) {
  const std::string n = std::to_string(points);
  const std::string header = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + columns + "\nWIDTH " + n +
                             "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
  const auto bytes = std::as_bytes(std::span(header));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Result<PcdCloud> parse_pcd(std::span<const std::byte> file, std::string_view name) {
  if (file.size() > kMaxPcdBytes) return Error{Errc::kLimit, "the file is too large", std::string(name), {}, {}};
  const auto header = parse_pcd_header(file, name);
  if (!header) return header.error();
  if (header->points > kMaxScanPoints)
    return Error{Errc::kLimit, "the cloud has too many points", std::string(name), {}, std::to_string(header->points)};
  const Chosen chosen = choose(*header);
  if (chosen[kX] == nullptr || chosen[kY] == nullptr || chosen[kZ] == nullptr)
    return Error{Errc::kUnsupported, "the cloud has no fields x, y and z", std::string(name), {}, {}};
  const auto data = file.subspan(header->data_offset);
  const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
  auto rows = header->ascii ? ascii_rows(text, *header, chosen, name) : binary_rows(data, *header, chosen, name);
  if (!rows) return rows.error();
  return to_cloud(std::move(*rows), chosen[kTime], name);
}

std::vector<std::byte> to_pcd(std::span<const std::string_view> fields, std::span<const float> values) {
  std::string names = "FIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT";
  for (const std::string_view field : fields) {
    names += " " + std::string(field);
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  std::vector<std::byte> out = header_of(names + sizes + types + counts, values.size() / fields.size());
  for (const float value : values) append_le(out, value);
  return out;
}

std::vector<std::byte> to_pcd(const PointCloud& cloud) {
  std::vector<std::byte> out = header_of(
      "FIELDS x y z intensity ring time return_type\nSIZE 4 4 4 4 2 4 1\nTYPE F F F F U F U\nCOUNT 1 1 1 1 1 1 1",
      cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const float v : {cloud.xyz[i].x(), cloud.xyz[i].y(), cloud.xyz[i].z(), cloud.intensity[i]}) append_le(out, v);
    append_le(out, static_cast<std::uint16_t>(cloud.ring[i]));
    append_le(out, static_cast<float>(1e-9 * cloud.offset_ns[i]));
    append_le(out, static_cast<std::uint8_t>(cloud.return_type[i]));
  }
  return out;
}

}  // namespace cairn::recording
