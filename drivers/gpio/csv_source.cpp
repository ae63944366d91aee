// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/csv_source.hpp"

namespace cairn::gpio {

Result<std::unique_ptr<CsvSource>> CsvSource::open(const std::filesystem::path& path, SourceId source) {
  auto file = LineFile::open(path, kMaxCsvLine);
  if (!file) return file.error();
  return std::unique_ptr<CsvSource>(new CsvSource(std::move(*file), source));
}

Result<Poll> CsvSource::next(Packet& packet, Duration) {
  for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
    if (ended_) return Poll::kEnd;
    const auto line = file_.next();
    if (!line) {
      ended_ = line.error().code == Errc::kIo;
      ++counters_.malformed;
      return line.error();
    }
    if (!*line) return ended_ = true, Poll::kEnd;
    const auto row = parse_csv(**line);
    if (!row) return ++counters_.malformed, file_.at_line(row.error());
    if (!*row) continue;
    const auto named = line_named((*row)->line);
    if (!named) {
      ++counters_.unknown;
      continue;
    }
    encode_event({*named, (*row)->level, false, 0}, packet);
    packet.source = source_;
    packet.sequence = counters_.delivered++;
    packet.arrival = Time{Duration{(*row)->stamp_ns}};
    packet.truncated = false;
    return Poll::kPacket;
  }
  return Poll::kTimeout;
}

}  // namespace cairn::gpio
