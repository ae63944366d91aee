// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/recording_writer.hpp"

#include <string>
#include <system_error>
#include <utility>

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// What is in the way of the new recording; empty: nothing.
fs::path existing_file(const fs::path& dir, const Recording& recording) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(dir / kIndexFile, ignored))) return dir / kIndexFile;
  for (const SourceEntry& source : recording.sources)
    if (const auto files = existing_files(dir, source); !files.empty()) return files.front();
  return {};
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const fs::path& dir, const Recording& recording) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) return Error{Errc::kIo, "cannot create the folder", dir.string(), {}, error.message()};
  if (const fs::path file = existing_file(dir, recording); !file.empty())
    return Error{Errc::kIo, "there is a recording already", file.string(), {}, "choose another folder"};
  RecordingWriter writer(dir, recording);
  writer.recording_.unfinished = true;
  if (auto saved = save_recording(dir, writer.recording_); !saved) return saved.error();
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
  if (!first) return first;
  recording_.unfinished = false;
  return save_recording(dir_, recording_);
}

}  // namespace cairn::recording
