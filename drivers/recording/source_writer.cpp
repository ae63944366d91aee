// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/source_writer.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/drive/can/candump.hpp"
#include "drivers/gpio/line_event.hpp"
#include "drivers/peers/peer_packet.hpp"
#include "drivers/recording/formats/image_folder.hpp"
#include "drivers/recording/formats/pcap_writer.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "hal/files/append_file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// The name of the robot's bus in drive.log: `canplayer vcan0=can0 -I drive.log` plays it on another bus.
constexpr const char* kBus = "can0";

/// The folder of the sweeps that `index` lists: scans for data.csv, and a folder of its own for any other index.
std::string scans_folder(const std::string& index) {
  return index == "data.csv" ? "scans" : "scans_" + fs::path(index).stem().string();
}

/// The factory address of the sensor, counted up for further sensors. Packets do not keep where they came from.
Ipv4 sensor_address(std::size_t source) { return {192, 168, 1, static_cast<std::uint8_t>(201 + source % 50)}; }

class Datagrams final : public SourceWriter {
 public:
  Datagrams(PcapWriter file, std::size_t source, std::int64_t offset)
      : file_(std::move(file)), source_(source), offset_(offset) {}
  Result<void> write(const Packet& p) override {
    return file_.write(p.arrival.time_since_epoch().count() + offset_, sensor_address(source_), p.channel, p.payload(),
                       p.truncated);
  }
  Result<void> flush() override { return file_.flush(); }
  Result<void> close() override { return file_.close(); }

 private:
  PcapWriter file_;
  std::size_t source_;
  std::int64_t offset_;
};

class Sweeps final : public SourceWriter {
 public:
  Sweeps(AppendFile index, fs::path dir, std::string folder)
      : index_(std::move(index)), dir_(std::move(dir)), folder_(std::move(folder)) {}
  Result<void> write(const Packet& packet) override;
  Result<void> flush() override { return index_.flush(); }
  Result<void> close() override { return index_.close(); }

 private:
  AppendFile index_;
  fs::path dir_;
  std::string folder_;  // relative to the recording
  std::uint64_t count_ = 0;
};

Result<void> Sweeps::write(const Packet& packet) {
  if (packet.bytes.size() > kMaxScanBytes || packet.channel > 1)
    return Error{Errc::kLimit, "not a sweep that can be recorded", index_.path().string(), {}, {}};
  char name[32];
  std::snprintf(name, sizeof name, "/%06llu.bin", static_cast<unsigned long long>(count_));
  auto file = AppendFile::create(dir_ / (folder_ + name));
  if (!file) return file.error();
  file->buffer().assign(packet.bytes.begin(), packet.bytes.end());
  if (auto written = file->end_record(); !written) return written;
  // Waiting for the disk after each of thousands of sweeps would take minutes.
  if (auto closed = file->close(false); !closed) return closed;
  ++count_;
  return index_.append_line(to_csv({packet.arrival, folder_ + name, static_cast<ScanLayout>(packet.channel)}));
}

class Pictures final : public SourceWriter {
 public:
  explicit Pictures(ImageFolderWriter folder) : folder_(std::move(folder)) {}
  Result<void> write(const Packet& packet) override { return folder_.write(packet); }
  Result<void> flush() override { return folder_.flush(); }
  Result<void> close() override { return folder_.close(); }

 private:
  ImageFolderWriter folder_;
};

/// Files of one line per packet.
class Lines : public SourceWriter {
 public:
  explicit Lines(AppendFile file) : file_(std::move(file)) {}
  Result<void> write(const Packet& packet) override {
    line_.clear();
    if (auto made = append(packet, line_); !made) return at(file_.path().string(), made.error());
    return file_.append_line(line_);
  }
  Result<void> flush() override { return file_.flush(); }
  Result<void> close() override { return file_.close(); }

 private:
  virtual Result<void> append(const Packet& packet, std::string& line) = 0;

  AppendFile file_;
  std::string line_;
};

class CanLines final : public Lines {
 public:
  CanLines(AppendFile file, std::int64_t offset) : Lines(std::move(file)), offset_(offset) {}

 private:
  Result<void> append(const Packet& packet, std::string& line) override {
    const auto frame = drive::decode_frame(packet.payload());
    if (!frame) return frame.error();
    const Time utc = packet.arrival + Duration{offset_};
    if (utc < Time{}) return Error{Errc::kMalformed, "a stamp before 1970", {}, {}, "realtime_offset_ns is wrong"};
    const auto sent = packet.channel == static_cast<std::uint16_t>(drive::Direction::kSent);
    append_candump(line, utc, kBus, *frame, sent ? std::optional(drive::Direction::kSent) : std::nullopt);
    return {};
  }
  std::int64_t offset_;
};

class GpioLines final : public Lines {
 public:
  using Lines::Lines;

 private:
  Result<void> append(const Packet& packet, std::string& line) override {
    const auto event = gpio::decode_event(packet);
    if (!event) return event.error();
    gpio::append_csv(line, packet.arrival.time_since_epoch().count(), gpio::name_of(event->line), event->level);
    return {};
  }
};

class LoggedPackets final : public SourceWriter {
 public:
  LoggedPackets(AppendFile file, const PacketLogFormat& format) : file_(std::move(file)), format_(format) {}
  Result<void> write(const Packet& packet) override {
    if (auto made = append_log_record(format_, packet, file_.buffer()); !made)
      return at(file_.path().string(), made.error());
    return file_.end_record();
  }
  Result<void> flush() override { return file_.flush(); }
  Result<void> close() override { return file_.close(); }

 private:
  AppendFile file_;
  PacketLogFormat format_;
};

using Opened = Result<std::unique_ptr<SourceWriter>>;

/// A source whose files are to be made.
struct Target {
  const fs::path& dir;
  const fs::path& file;
  const Recording& recording;
  const SourceEntry& entry;
  std::size_t index;
};

Opened open_datagrams(const Target& t) {
  auto pcap = PcapWriter::create(t.file);
  if (!pcap) return pcap.error();
  return std::unique_ptr<SourceWriter>(
      std::make_unique<Datagrams>(std::move(*pcap), t.index, t.recording.realtime_offset_ns));
}

Opened open_pictures(const Target& t) {
  auto folder = ImageFolderWriter::create(t.file.parent_path());
  if (!folder) return folder.error();
  return std::unique_ptr<SourceWriter>(std::make_unique<Pictures>(std::move(*folder)));
}

Opened open_sweeps(const Target& t) {
  auto index = AppendFile::create(t.file);
  if (!index) return index.error();
  const std::string folder = scans_folder(t.entry.file);
  std::error_code error;
  fs::create_directories(t.dir / folder, error);
  if (error) return Error{Errc::kIo, "cannot create the folder", (t.dir / folder).string(), {}, error.message()};
  if (auto header = index->append_line(kScanIndexHeader); !header) return header.error();
  return std::unique_ptr<SourceWriter>(std::make_unique<Sweeps>(std::move(*index), t.dir, folder));
}

Opened open_can(const Target& t) {
  auto file = AppendFile::create(t.file);
  if (!file) return file.error();
  return std::unique_ptr<SourceWriter>(std::make_unique<CanLines>(std::move(*file), t.recording.realtime_offset_ns));
}

Opened open_gpio(const Target& t) {
  auto file = AppendFile::create(t.file);
  if (!file) return file.error();
  if (auto header = file->append_line(gpio::kCsvHeader); !header) return header.error();
  return std::unique_ptr<SourceWriter>(std::make_unique<GpioLines>(std::move(*file)));
}

template <const PacketLogFormat& kFormat>
Opened open_log(const Target& t) {
  auto file = AppendFile::create(t.file);
  if (!file) return file.error();
  append_log_header(kFormat, file->buffer());
  if (auto header = file->end_record(); !header) return header.error();
  return std::unique_ptr<SourceWriter>(std::make_unique<LoggedPackets>(std::move(*file), kFormat));
}

/// Adds the files of a source that its own file lists.
using AddListed = void (*)(const fs::path& dir, const SourceEntry& entry, std::vector<fs::path>& files);

void add_files(const fs::path& folder, std::initializer_list<const char*> extensions, std::vector<fs::path>& files) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    for (const char* extension : extensions)
      if (entry.is_regular_file(error) && entry.path().extension() == extension) files.push_back(entry.path());
}
void add_nothing(const fs::path& /*dir*/, const SourceEntry& /*entry*/, std::vector<fs::path>& /*files*/) {}
void add_sweeps(const fs::path& dir, const SourceEntry& entry, std::vector<fs::path>& files) {
  add_files(dir / scans_folder(entry.file), {".bin"}, files);
}
void add_pictures(const fs::path& dir, const SourceEntry& entry, std::vector<fs::path>& files) {
  add_files((dir / entry.file).parent_path() / "data", {".png", ".jpg"}, files);
}

struct WriterRow {
  SensorKind kind;
  Opened (*open)(const Target&);
  AddListed add_listed;
};
constexpr std::array kWriters{
    WriterRow{.kind = kVelodyne, .open = open_datagrams, .add_listed = add_nothing},
    WriterRow{.kind = kScans, .open = open_sweeps, .add_listed = add_sweeps},
    WriterRow{.kind = kCamera, .open = open_pictures, .add_listed = add_pictures},
    WriterRow{.kind = kThermal, .open = open_pictures, .add_listed = add_pictures},
    WriterRow{.kind = kDepth, .open = open_pictures, .add_listed = add_pictures},
    WriterRow{.kind = kDrive, .open = open_can, .add_listed = add_nothing},
    WriterRow{.kind = kGpio, .open = open_gpio, .add_listed = add_nothing},
    WriterRow{.kind = kPeers, .open = open_log<peer_link::kPeersLog>, .add_listed = add_nothing},
    WriterRow{.kind = kCommands, .open = open_log<clients::kCommandsLog>, .add_listed = add_nothing},
};
static_assert(one_row_per_kind(kWriters));

}  // namespace

Result<std::unique_ptr<SourceWriter>> open_source_writer(const fs::path& dir, const Recording& recording,
                                                         std::size_t index) {
  const SourceEntry& entry = recording.sources[index];
  const fs::path file = dir / entry.file;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return Error{Errc::kIo, "cannot create the folder", file.parent_path().string(), {}, error.message()};
  return row_of(entry.kind, kWriters)
      .open({.dir = dir, .file = file, .recording = recording, .entry = entry, .index = index});
}

std::vector<fs::path> existing_files(const fs::path& dir, const SourceEntry& entry) {
  std::vector<fs::path> files;
  if (path_fault(entry.file) != nullptr) return files;
  const fs::path own = dir / entry.file;
  std::error_code error;
  if (fs::exists(fs::symlink_status(own, error))) files.push_back(own);
  row_of(entry.kind, kWriters).add_listed(dir, entry, files);
  return files;
}

}  // namespace cairn::recording
