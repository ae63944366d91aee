// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/scan_file.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "hal/bytes.hpp"

namespace cairn::recording {
namespace {

constexpr float kMaxMetres = 1e4F;
constexpr std::uint32_t kMaxOffsetNs = 2'000'000'000;

struct Record {
  float x, y, z, intensity;
  std::uint32_t offset_ns;
};

Record load_record(std::span<const std::byte> bytes, std::size_t at, ScanLayout layout) {
  return {load_le<float>(bytes, at), load_le<float>(bytes, at + 4), load_le<float>(bytes, at + 8),
          load_le<float>(bytes, at + 12), layout == ScanLayout::kXyzi ? 0 : load_le<std::uint32_t>(bytes, at + 16)};
}

bool usable(const Record& r) {
  // Written so that a NaN fails.
  return std::abs(r.x) <= kMaxMetres && std::abs(r.y) <= kMaxMetres && std::abs(r.z) <= kMaxMetres &&
         std::isfinite(r.intensity) && r.offset_ns <= kMaxOffsetNs;
}

Result<ScanIndexEntry> parse_entry(const LineReader& lines, std::string_view line) {
  std::string_view parts[3];
  const std::size_t n = split(line, ',', parts);
  if (n != 2 && n != 3) return lines.fault(Errc::kMalformed, "stamp_ns,file[,has_offset] expected");
  const auto ns = parse_integer(parts[0]);
  if (!ns || *ns < -kMaxUtcNs || *ns > kMaxUtcNs)
    return lines.fault(Errc::kMalformed, "not a stamp in nanoseconds", std::string(parts[0].substr(0, 40)));
  if (const char* fault = path_fault(parts[1]); fault != nullptr)
    return lines.fault(Errc::kMalformed, "not a usable file name", fault);
  if (n == 3 && parts[2] != "0" && parts[2] != "1")
    return lines.fault(Errc::kMalformed, "has_offset must be 0 or 1", std::string(parts[2].substr(0, 40)));
  const bool has_offset = n == 3 && parts[2] == "1";
  return ScanIndexEntry{Time(Duration(*ns)), std::string(parts[1]),
                        has_offset ? ScanLayout::kXyziOffset : ScanLayout::kXyzi};
}

}  // namespace

Result<void> parse_scan_index(std::string_view text, std::string_view name, std::vector<ScanIndexEntry>& entries) {
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || content.front() == '#') continue;
    auto entry = parse_entry(lines, content);
    if (!entry) return entry.error();
    if (!entries.empty() && entry->stamp <= entries.back().stamp)
      return lines.fault(Errc::kMalformed, "the stamps do not increase");
    entries.push_back(std::move(*entry));
  }
  return {};
}

std::string to_csv(const ScanIndexEntry& entry) {
  return std::to_string(entry.stamp.time_since_epoch().count()) + "," + entry.file +
         (entry.layout == ScanLayout::kXyziOffset ? ",1\n" : ",0\n");
}

std::vector<std::byte> encode_scan(const PointCloud& cloud, bool with_offset) {
  std::vector<std::byte> out;
  out.reserve(cloud.size() * (with_offset ? 20 : 16));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const float v : {cloud.xyz[i].x(), cloud.xyz[i].y(), cloud.xyz[i].z(), cloud.intensity[i]}) append_le(out, v);
    if (with_offset) append_le(out, cloud.offset_ns[i]);
  }
  return out;
}

Result<const Scan*> ScanFileDecoder::reject(Errc code, std::string_view cause, const Packet& packet) {
  ++rejected_packets_;
  return Error{code, cause, {}, packet.bytes.size(), "sweep " + std::to_string(packet.sequence)};
}

Result<const Scan*> ScanFileDecoder::decode(const Packet& packet) {
  if (packet.channel > 1) return reject(Errc::kUnsupported, "unknown layout of a sweep", packet);
  const auto layout = static_cast<ScanLayout>(packet.channel);
  const std::size_t stride = record_bytes(layout);
  const std::size_t points = packet.bytes.size() / stride;
  if (packet.truncated) return reject(Errc::kTruncated, "the sweep is cut short", packet);
  if (points > kMaxScanPoints) return reject(Errc::kLimit, "the sweep has too many points", packet);
  if (packet.bytes.size() % stride != 0)
    return reject(Errc::kMalformed, "the size of a sweep must be a multiple of its record", packet);

  scan_.cloud.clear();
  scan_.cloud.reserve(points);
  std::uint32_t last_offset = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const Record r = load_record(packet.payload(), i * stride, layout);
    if (!usable(r)) {
      ++rejected_points_;
      continue;
    }
    last_offset = std::max(last_offset, r.offset_ns);
    scan_.cloud.push_back({r.x, r.y, r.z}, r.intensity, r.offset_ns, 0, ReturnType::kStrongest);
  }
  scan_.source = packet.source;
  scan_.valid = {packet.arrival - Duration(last_offset), packet.arrival};
  scan_.deskewed = deskewed_;
  return &scan_;
}

}  // namespace cairn::recording
