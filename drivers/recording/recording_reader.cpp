// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/recording_reader.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/drive/can/candump_source.hpp"
#include "drivers/gpio/csv_source.hpp"
#include "drivers/peers/peer_packet.hpp"
#include "drivers/recording/formats/image_folder.hpp"
#include "drivers/recording/scan_source.hpp"
#include "drivers/recording/stamp_guard.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"

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

/// A file with stamps in UTC, put on the robot's time line.
class UtcSource final : public Source {
 public:
  UtcSource(std::unique_ptr<Source> utc, std::string file, std::int64_t realtime_offset_ns)
      : utc_(std::move(utc)), file_(std::move(file)), offset_(realtime_offset_ns) {}

  Result<Poll> next(Packet& packet, Duration timeout) override {
    const auto poll = utc_->next(packet, timeout);
    if (!poll || *poll != Poll::kPacket) return poll;
    const std::int64_t utc = packet.arrival.time_since_epoch().count();
    packet.arrival -= offset_;
    const std::int64_t ns = packet.arrival.time_since_epoch().count();
    if (utc >= -kMaxUtcNs && utc <= kMaxUtcNs && ns >= -kMaxUtcNs && ns <= kMaxUtcNs) return Poll::kPacket;
    return Error{Errc::kMalformed,
                 "a stamp lies beyond any robot's time line",
                 file_,
                 {},
                 "packet " + std::to_string(packet.sequence) + ", realtime_offset_ns is wrong"};
  }

 private:
  std::unique_ptr<Source> utc_;
  std::string file_;
  Duration offset_;
};

/// A capture file that says once when it ends inside a record.
class CaptureSource final : public Source {
 public:
  CaptureSource(std::unique_ptr<PcapSource> capture, std::string file)
      : capture_(std::move(capture)), file_(std::move(file)) {}

  Result<Poll> next(Packet& packet, Duration timeout) override {
    const auto poll = capture_->next(packet, timeout);
    if (!poll || *poll != Poll::kEnd) return poll;
    if (!capture_->counters().truncated_tail || std::exchange(tail_reported_, true)) return Poll::kEnd;
    return Error{Errc::kTruncated,
                 "the capture ends inside its last record",
                 file_,
                 {},
                 "after " + std::to_string(capture_->counters().records) + " whole records"};
  }

 private:
  std::unique_ptr<PcapSource> capture_;
  std::string file_;
  bool tail_reported_ = false;
};

using Opened = Result<std::unique_ptr<Source>>;

template <class T>
Opened as_source(Result<std::unique_ptr<T>> opened) {
  if (!opened) return opened.error();
  return std::unique_ptr<Source>(std::move(*opened));
}

/// A source that is to be opened.
struct Recorded {
  const std::filesystem::path& dir;
  const Recording& recording;
  const SourceEntry& entry;
  SourceId id;

  [[nodiscard]] Result<std::filesystem::path> file() const { return resolve_inside(dir, entry.file); }
};

Opened on_robot_time(Opened utc, const std::filesystem::path& file, const Recorded& r) {
  if (!utc) return utc;
  return std::unique_ptr<Source>(
      std::make_unique<UtcSource>(std::move(*utc), file.string(), r.recording.realtime_offset_ns));
}

Opened open_capture(const Recorded& r) {
  const auto file = r.file();
  if (!file) return file.error();
  PcapSource::Options options;
  options.source = r.id;
  options.ports = {r.entry.data_port, r.entry.position_port};
  auto opened = PcapSource::open(*file, options);
  if (!opened) return opened.error();
  const PcapSource* capture = opened->get();
  auto whole = std::make_unique<CaptureSource>(std::move(*opened), file->string());
  auto guarded =
      std::make_unique<GuardedSource>(std::move(whole), file->string(), [capture] { return capture->record_offset(); });
  return on_robot_time(std::unique_ptr<Source>(std::move(guarded)), *file, r);
}

Opened guarded(Opened opened, const std::string& file) {
  if (!opened) return opened;
  return std::unique_ptr<Source>(std::make_unique<GuardedSource>(std::move(*opened), file));
}

Opened open_scans(const Recorded& r) {
  return guarded(as_source(ScanSource::open(r.dir, r.entry.file)), (r.dir / r.entry.file).string());
}

template <camera::FrameFormat kDeepFormat>
Opened open_pictures(const Recorded& r) {
  return as_source(ImageFolderSource::open(r.dir, r.entry.file, {r.id, kDeepFormat}));
}

Opened open_can(const Recorded& r) {
  const auto file = r.file();
  if (!file) return file.error();
  const drive::CandumpSource::Options options{
      .source = r.id, .interface = {}, .stamps = drive::CandumpTime::Stamps::kSinceStart};
  return on_robot_time(guarded(as_source(drive::CandumpSource::open(*file, options)), file->string()), *file, r);
}

Opened open_gpio(const Recorded& r) {
  const auto file = r.file();
  if (!file) return file.error();
  return as_source(gpio::CsvSource::open(*file, r.id));
}

template <const PacketLogFormat& kFormat>
Opened open_log(const Recorded& r) {
  const auto file = r.file();
  if (!file) return file.error();
  return as_source(PacketLogSource::open(*file, kFormat, r.id));
}

struct ReaderRow {
  SensorKind kind;
  Opened (*open)(const Recorded&);
};
constexpr std::array kReaders{
    ReaderRow{kVelodyne, open_capture},
    ReaderRow{kScans, open_scans},
    ReaderRow{kCamera, open_pictures<camera::FrameFormat::kY16>},
    ReaderRow{kThermal, open_pictures<camera::FrameFormat::kY16>},
    ReaderRow{kDepth, open_pictures<camera::FrameFormat::kZ16>},
    ReaderRow{kDrive, open_can},
    ReaderRow{kGpio, open_gpio},
    ReaderRow{kPeers, open_log<peer_link::kPeersLog>},
    ReaderRow{kCommands, open_log<clients::kCommandsLog>},
};
static_assert(one_row_per_kind(kReaders));

}  // namespace

Result<std::unique_ptr<Source>> open_recorded_source(const std::filesystem::path& dir, const Recording& recording,
                                                     std::size_t i) {
  const SourceEntry& entry = recording.sources[i];
  return row_of(entry.kind, kReaders).open({dir, recording, entry, static_cast<SourceId>(i)});
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(const std::filesystem::path& dir) {
  auto recording = load_recording(dir);
  if (!recording) return recording.error();
  std::vector<std::unique_ptr<Source>> sources;
  for (std::size_t i = 0; i < recording->sources.size(); ++i) {
    auto source = open_recorded_source(dir, *recording, i);
    if (source)
      sources.push_back(std::move(*source));
    else
      sources.push_back(std::make_unique<FailedSource>(source.error()));
  }
  return std::unique_ptr<RecordingReader>(new RecordingReader(std::move(*recording), std::move(sources)));
}

}  // namespace cairn::recording
