// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/recording_reader.hpp"

#include <optional>
#include <string>
#include <utility>

#include "drivers/recording/scan_source.hpp"
#include "drivers/velodyne/pcap_source.hpp"

namespace cairn::recording {
namespace {

using velodyne::PcapSource;

/// A source that could not be opened: says so once.
class FailedSource final : public Source {
 public:
  explicit FailedSource(Error error) : error_(std::move(error)) {}
  Result<Poll> next(Packet&, Duration) override {
    if (error_) return *std::exchange(error_, std::nullopt);
    return Poll::kEnd;
  }

 private:
  std::optional<Error> error_;
};

/// A capture file with its UTC stamps put on the robot's time line.
class CaptureSource final : public Source {
 public:
  CaptureSource(std::unique_ptr<PcapSource> capture, std::string file, std::int64_t realtime_offset_ns)
      : capture_(std::move(capture)), file_(std::move(file)), offset_(realtime_offset_ns) {}

  Result<Poll> next(Packet& packet, Duration timeout) override {
    const auto poll = capture_->next(packet, timeout);
    if (!poll || *poll == Poll::kTimeout) return poll;
    if (*poll == Poll::kEnd) return end();
    packet.arrival -= offset_;
    const std::int64_t ns = packet.arrival.time_since_epoch().count();
    if (ns >= -kMaxUtcNs && ns <= kMaxUtcNs) return Poll::kPacket;
    return Error{Errc::kMalformed,
                 "a stamp lies beyond any robot's time line",
                 file_,
                 {},
                 "packet " + std::to_string(packet.sequence) + ", realtime_offset_ns is wrong"};
  }

 private:
  Result<Poll> end() {
    if (!capture_->counters().truncated_tail || std::exchange(tail_reported_, true)) return Poll::kEnd;
    return Error{Errc::kTruncated,
                 "the capture ends inside its last record",
                 file_,
                 {},
                 "after " + std::to_string(capture_->counters().records) + " whole records"};
  }

  std::unique_ptr<PcapSource> capture_;
  std::string file_;
  Duration offset_;
  bool tail_reported_ = false;
};

Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& dir, const Recording& recording,
                                            std::size_t i) {
  const SourceEntry& entry = recording.sources[i];
  if (entry.kind == kScans) {
    auto scans = ScanSource::open(dir, entry.file);
    if (!scans) return scans.error();
    return std::unique_ptr<Source>(std::move(*scans));
  }
  const auto file = resolve_inside(dir, entry.file);
  if (!file) return file.error();
  PcapSource::Options options;
  options.source = static_cast<SourceId>(i);
  options.ports = {entry.data_port, entry.position_port};
  auto capture = PcapSource::open(*file, options);
  if (!capture) return capture.error();
  return std::unique_ptr<Source>(
      std::make_unique<CaptureSource>(std::move(*capture), file->string(), recording.realtime_offset_ns));
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(const std::filesystem::path& dir) {
  auto recording = load_recording(dir);
  if (!recording) return recording.error();
  std::vector<std::unique_ptr<Source>> sources;
  for (std::size_t i = 0; i < recording->sources.size(); ++i) {
    auto source = open_source(dir, *recording, i);
    if (source)
      sources.push_back(std::move(*source));
    else
      sources.push_back(std::make_unique<FailedSource>(source.error()));
  }
  return std::unique_ptr<RecordingReader>(new RecordingReader(std::move(*recording), std::move(sources)));
}

}  // namespace cairn::recording
