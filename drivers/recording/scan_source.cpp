// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/scan_source.hpp"

#include <string_view>
#include <utility>

#include "drivers/recording/formats/recording.hpp"
#include "hal/files/file.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// read_file() into memory that is there already.
Result<void> read_into(const fs::path& path, std::vector<std::byte>& bytes) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  if (file->size() > kMaxScanBytes)
    return Error{Errc::kLimit, "the sweep is too large", path.string(), {}, std::to_string(file->size()) + " bytes"};
  bytes.resize(static_cast<std::size_t>(file->size()));
  const auto read = file->read(bytes);
  if (!read) return read.error();
  if (*read == bytes.size()) return {};
  return Error{Errc::kIo, "cannot read the sweep", path.string(), *read, {}};
}

}  // namespace

Result<std::unique_ptr<ScanSource>> ScanSource::open(fs::path dir, const std::string& index) {
  const auto path = resolve_inside(dir, index);
  if (!path) return path.error();
  const auto bytes = read_file(*path, kMaxIndexBytes);
  if (!bytes) return bytes.error();
  std::unique_ptr<ScanSource> source(new ScanSource(std::move(dir)));
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (auto parsed = parse_scan_index(text, path->string(), source->entries_); !parsed) source->damage_ = parsed.error();
  return source;
}

Result<Poll> ScanSource::next(Packet& packet, Duration) {
  if (next_ == entries_.size()) {
    if (!damage_) return Poll::kEnd;
    return *std::exchange(damage_, std::nullopt);
  }
  const ScanIndexEntry& entry = entries_[next_++];
  const auto path = resolve_inside(dir_, entry.file);
  if (!path) return path.error();
  if (auto read = read_into(*path, packet.bytes); !read) return read.error();
  packet.channel = static_cast<std::uint16_t>(entry.layout);
  packet.sequence = next_ - 1;
  packet.arrival = entry.stamp;
  packet.truncated = false;
  return Poll::kPacket;
}

}  // namespace cairn::recording
