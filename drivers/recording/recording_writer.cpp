// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/recording_writer.hpp"

#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "drivers/recording/scan_file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGroundTruth = "ground_truth.tum";

/// The folder of the sweeps listed in `index`: scans for data.csv, and one of its own for any other index.
std::string scans_folder(const std::string& index) {
  return index == "data.csv" ? "scans" : "scans_" + fs::path(index).stem().string();
}

bool is_sweep(const fs::directory_entry& entry) {
  std::error_code ignored;
  return entry.is_regular_file(ignored) && entry.path().extension() == ".bin";
}

/// The files that a recording with these sources owns in `dir`, as far as they exist.
std::vector<fs::path> owned_files(const fs::path& dir, const Recording& recording) {
  std::vector<fs::path> files{dir / kIndexFile, dir / kGroundTruth};
  std::error_code error;
  for (const SourceEntry& s : recording.sources) {
    if (path_fault(s.file) != nullptr) continue;
    files.push_back(dir / s.file);
    if (s.kind != kScans) continue;
    for (const auto& entry : fs::directory_iterator(dir / scans_folder(s.file), error))
      if (is_sweep(entry)) files.push_back(entry.path());
  }
  std::erase_if(files, [](const fs::path& f) {
    std::error_code ignored;
    return !fs::exists(fs::symlink_status(f, ignored));
  });
  return files;
}

Error io_error(std::string_view cause, const fs::path& path, const std::error_code& error) {
  return Error{Errc::kIo, cause, path.string(), {}, error.message()};
}

/// Makes room for the new recording, or says what is in the way.
Result<void> clear(const fs::path& dir, const Recording& recording, Overwrite overwrite) {
  std::vector<fs::path> files = owned_files(dir, recording);
  if (files.empty()) return {};
  if (overwrite == Overwrite::kNo)
    return Error{Errc::kIo,
                 "there is a recording already",
                 files.front().string(),
                 {},
                 "choose another folder or allow overwriting"};
  if (const auto old = load_recording(dir))
    for (fs::path& f : owned_files(dir, *old)) files.push_back(std::move(f));
  for (const fs::path& file : files) {
    std::error_code error;
    fs::remove(file, error);
    if (error) return io_error("cannot remove the old file", file, error);
  }
  return {};
}

/// The sensor's factory address, counted up for further sensors: a recording does not know where its packets came from.
Ipv4 sensor_address(std::size_t source) { return {192, 168, 1, static_cast<std::uint8_t>(201 + source % 50)}; }

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const fs::path& dir, const Recording& recording, Overwrite overwrite) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) return io_error("cannot create the folder", dir, error);
  if (auto cleared = clear(dir, recording, overwrite); !cleared) return cleared.error();
  if (auto saved = save_recording(dir, recording); !saved) return saved.error();
  RecordingWriter writer(dir, recording);
  if (auto opened = writer.open_outputs(); !opened) return opened.error();
  return writer;
}

Result<void> RecordingWriter::open_outputs() {
  for (const SourceEntry& s : recording_.sources) {
    std::error_code error;
    const fs::path file = dir_ / s.file;
    const std::string folder = scans_folder(s.file);
    fs::create_directories(s.kind == kScans ? dir_ / folder : file.parent_path(), error);
    fs::create_directories(file.parent_path(), error);
    if (error) return io_error("cannot create a folder of the recording", file, error);
    if (s.kind == kVelodyne) {
      auto pcap = PcapWriter::create(file);
      if (!pcap) return pcap.error();
      outputs_.emplace_back(std::move(*pcap));
      continue;
    }
    auto index = AppendFile::create(file);
    if (!index) return index.error();
    if (auto header = index->append_line(kScanIndexHeader); !header) return header.error();
    outputs_.emplace_back(Scans{std::move(*index), folder});
  }
  return {};
}

Result<void> RecordingWriter::write_scan(Scans& scans, const Packet& packet) {
  if (packet.bytes.size() > kMaxScanBytes || packet.channel > 1)
    return Error{Errc::kLimit, "not a sweep that can be recorded", scans.index.path().string(), {}, {}};
  char name[32];
  std::snprintf(name, sizeof name, "/%06llu.bin", static_cast<unsigned long long>(scans.count));
  auto file = AppendFile::create(dir_ / (scans.folder + name));
  if (!file) return file.error();
  file->buffer().assign(packet.bytes.begin(), packet.bytes.end());
  if (auto written = file->end_record(); !written) return written;
  // Waiting for the disk after each of thousands of sweeps would take minutes.
  if (auto closed = file->close(false); !closed) return closed;
  ++scans.count;
  return scans.index.append_line(
      to_csv({packet.arrival, scans.folder + name, static_cast<ScanLayout>(packet.channel)}));
}

Result<void> RecordingWriter::write(const Packet& packet) {
  const auto source = static_cast<std::size_t>(packet.source);
  if (source >= outputs_.size())
    return Error{Errc::kNotFound, "the recording has no such source", dir_.string(), {}, std::to_string(source)};
  Output& output = outputs_[source];
  auto* pcap = std::get_if<PcapWriter>(&output);
  auto written = pcap != nullptr ? pcap->write(recording_.utc_ns(packet.arrival), sensor_address(source),
                                               packet.channel, packet.payload(), packet.truncated)
                                 : write_scan(std::get<Scans>(output), packet);
  if (!written) return written;
  ++packets_;
  payload_bytes_ += packet.bytes.size();
  return {};
}

Result<void> RecordingWriter::flush() {
  Result<void> first;
  for (Output& output : outputs_) {
    auto* pcap = std::get_if<PcapWriter>(&output);
    auto flushed = pcap != nullptr ? pcap->flush() : std::get<Scans>(output).index.flush();
    if (!flushed && first) first = flushed;
  }
  return first;
}

Result<void> RecordingWriter::close() {
  Result<void> first;
  for (Output& output : outputs_) {
    auto* pcap = std::get_if<PcapWriter>(&output);
    auto closed = pcap != nullptr ? pcap->close() : std::get<Scans>(output).index.close();
    if (!closed && first) first = closed;
  }
  outputs_.clear();
  return first;
}

}  // namespace cairn::recording
