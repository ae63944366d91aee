// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/text_lines.hpp"

namespace cairn::recording {
namespace {

constexpr std::size_t kMaxFields = 64, kMaxHeaderBytes = 16 * 1024, kMaxCount = 4096;

/// The header as its lines come in; checked when DATA has been seen.
struct Parts {
  std::string_view fields[kMaxFields], sizes[kMaxFields], types[kMaxFields], counts[kMaxFields];
  std::size_t field_count = 0, size_count = 0, type_count = 0, count_count = 0;
  std::optional<std::int64_t> width, height, points;
};

std::optional<std::int64_t> bounded(std::string_view text, std::int64_t min, std::int64_t max) {
  const auto value = parse_integer(text);
  return value && *value >= min && *value <= max ? value : std::nullopt;
}

Result<void> read_line(Parts& parts, const LineReader& lines, std::string_view key, std::string_view rest) {
  const auto list = [&](std::string_view(&out)[kMaxFields], std::size_t& n) -> Result<void> {
    n = split(rest, ' ', out);
    if (n > kMaxFields) return lines.fault(Errc::kLimit, "too many fields", std::to_string(n));
    return {};
  };
  const auto number = [&](std::optional<std::int64_t>& out) -> Result<void> {
    out = bounded(rest, 0, static_cast<std::int64_t>(kMaxPcdBytes));
    if (!out) return lines.fault(Errc::kMalformed, "not a usable number of points", std::string(rest.substr(0, 40)));
    return {};
  };
  if (key == "FIELDS") return list(parts.fields, parts.field_count);
  if (key == "SIZE") return list(parts.sizes, parts.size_count);
  if (key == "TYPE") return list(parts.types, parts.type_count);
  if (key == "COUNT") return list(parts.counts, parts.count_count);
  if (key == "WIDTH") return number(parts.width);
  if (key == "HEIGHT") return number(parts.height);
  if (key == "POINTS") return number(parts.points);
  if (key == "VERSION" || key == "VIEWPOINT") return {};
  return lines.fault(Errc::kMalformed, "not a line of a PCD header", std::string(key.substr(0, 40)));
}

Result<PcdField> make_field(const Parts& parts, std::size_t i, const LineReader& lines) {
  PcdField field;
  field.name = parts.fields[i];
  const auto size = bounded(parts.sizes[i], 1, 8);
  const auto count = parts.count_count == 0 ? std::optional<std::int64_t>(1) : bounded(parts.counts[i], 1, kMaxCount);
  field.type = parts.types[i].size() == 1 ? parts.types[i].front() : '?';
  const bool known = field.type == 'F' ? size == 4 || size == 8
                                       : (field.type == 'I' || field.type == 'U') &&
                                             (size == 1 || size == 2 || size == 4 || size == 8);
  if (!known || !count)
    return lines.fault(Errc::kMalformed, "impossible SIZE, TYPE or COUNT of a field", field.name.substr(0, 40));
  field.size = static_cast<std::size_t>(*size);
  field.count = static_cast<std::size_t>(*count);
  return field;
}

Result<PcdHeader> finish(const Parts& parts, const LineReader& lines) {
  const std::size_t n = parts.field_count;
  if (n == 0 || parts.size_count != n || parts.type_count != n || (parts.count_count != 0 && parts.count_count != n))
    return lines.fault(Errc::kMalformed, "FIELDS, SIZE, TYPE and COUNT must list the same fields");
  PcdHeader header;
  for (std::size_t i = 0; i < n; ++i) {
    auto field = make_field(parts, i, lines);
    if (!field) return field.error();
    field->offset = header.point_bytes;
    header.point_bytes += field->size * field->count;
    header.fields.push_back(std::move(*field));
  }
  // Both factors are below 2^28, so the product cannot overflow.
  const std::int64_t area = parts.width.value_or(0) * parts.height.value_or(1);
  const std::int64_t points = parts.points.value_or(area);
  if ((!parts.points && !parts.width) || (parts.width && area != points))
    return lines.fault(Errc::kMalformed, "POINTS must be there and equal WIDTH times HEIGHT");
  if (points > static_cast<std::int64_t>(kMaxPcdBytes)) return lines.fault(Errc::kLimit, "too many points");
  header.points = static_cast<std::size_t>(points);
  return header;
}

}  // namespace

const PcdField* PcdHeader::field(std::string_view name) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const PcdField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

Result<PcdHeader> parse_pcd_header(std::span<const std::byte> file, std::string_view name) {
  const auto head = file.first(std::min(file.size(), kMaxHeaderBytes));
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  LineReader lines(text, name);
  Parts parts;
  while (const auto line = lines.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || content.front() == '#') continue;
    const std::size_t space = std::min(content.find_first_of(" \t"), content.size());
    const std::string_view key = content.substr(0, space), rest = trimmed(content.substr(space));
    if (key != "DATA") {
      if (auto read = read_line(parts, lines, key, rest); !read) return read.error();
      continue;
    }
    if (rest == "binary_compressed")
      return lines.fault(Errc::kUnsupported, "compressed PCD files are not read",
                         "convert to DATA binary (pcl_convert_pcd_ascii_binary)");
    if (rest != "ascii" && rest != "binary") return lines.fault(Errc::kMalformed, "DATA must be ascii or binary");
    auto header = finish(parts, lines);
    if (!header) return header;
    header->ascii = rest == "ascii";
    header->data_offset = std::min<std::size_t>(lines.next_offset(), file.size());
    return header;
  }
  return lines.fault(Errc::kTruncated, "the PCD header has no DATA line");
}

}  // namespace cairn::recording
