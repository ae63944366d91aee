// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/recording_writer.hpp"

#include <string>
#include <system_error>
#include <utility>

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGroundTruth = "ground_truth.tum";

/// The files that a recording with these sources owns in `dir`, as far as they exist.
std::vector<fs::path> owned_files(const fs::path& dir, const Recording& recording) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const char* name : {kIndexFile, kGroundTruth})
    if (fs::exists(fs::symlink_status(dir / name, ignored))) files.push_back(dir / name);
  for (const SourceEntry& source : recording.sources)
    for (fs::path& file : existing_files(dir, source)) files.push_back(std::move(file));
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
  for (std::size_t i = 0; i < recording_.sources.size(); ++i) {
    auto output = open_source_writer(dir_, recording_, i);
    if (!output) return output.error();
    outputs_.push_back(std::move(*output));
  }
  return {};
}

Result<void> RecordingWriter::write(const Packet& packet) {
  const auto source = static_cast<std::size_t>(packet.source);
  if (source >= outputs_.size())
    return Error{Errc::kNotFound, "the recording has no such source", dir_.string(), {}, std::to_string(source)};
  if (auto written = outputs_[source]->write(packet); !written) return written;
  ++packets_;
  payload_bytes_ += packet.bytes.size();
  ++written_[source].packets;
  written_[source].payload_bytes += packet.bytes.size();
  return {};
}

Result<void> RecordingWriter::flush() {
  Result<void> first;
  for (const auto& output : outputs_)
    if (auto flushed = output->flush(); !flushed && first) first = flushed;
  return first;
}

Result<void> RecordingWriter::close() {
  Result<void> first;
  for (const auto& output : outputs_)
    if (auto closed = output->close(); !closed && first) first = closed;
  outputs_.clear();
  return first;
}

}  // namespace cairn::recording
