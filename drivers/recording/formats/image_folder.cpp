// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/image_folder.hpp"

#include <system_error>
#include <utility>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictures = "data";

Result<ImageIndexEntry> parse_entry(const LineReader& lines, std::string_view line) {
  std::string_view parts[2];
  if (split(line, ',', parts) != 2) return lines.fault(Errc::kMalformed, "stamp_ns,file expected");
  const auto ns = parse_integer(parts[0]);
  if (!ns || *ns < -kMaxUtcNs || *ns > kMaxUtcNs)
    return lines.fault(Errc::kMalformed, "not a stamp in nanoseconds", std::string(parts[0].substr(0, 40)));
  if (const char* fault = path_fault(parts[1]); fault != nullptr)
    return lines.fault(Errc::kMalformed, "not a usable file name", fault);
  return ImageIndexEntry{Time(Duration(*ns)), std::string(parts[1])};
}

}  // namespace

Result<void> parse_image_index(std::string_view text, std::string_view name, std::vector<ImageIndexEntry>& entries) {
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

std::string to_csv(const ImageIndexEntry& entry) {
  return std::to_string(entry.stamp.time_since_epoch().count()) + "," + entry.file + "\n";
}

Result<std::unique_ptr<ImageFolderSource>> ImageFolderSource::open(fs::path dir, const std::string& index,
                                                                   const Options& options) {
  const auto path = resolve_inside(dir, index);
  if (!path) return path.error();
  const auto bytes = read_file(*path, kMaxIndexBytes);
  if (!bytes) return bytes.error();
  std::string pictures = (fs::path(index).parent_path() / kPictures).generic_string() + "/";
  std::unique_ptr<ImageFolderSource> source(new ImageFolderSource(std::move(dir), std::move(pictures), options));
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (auto parsed = parse_image_index(text, path->string(), source->entries_); !parsed)
    source->damage_ = parsed.error();
  return source;
}

Result<Poll> ImageFolderSource::next(Packet& packet, Duration) {
  if (next_ == entries_.size()) {
    if (!damage_) return Poll::kEnd;
    return *std::exchange(damage_, std::nullopt);
  }
  const ImageIndexEntry& entry = entries_[next_++];
  const auto path = resolve_inside(dir_, pictures_ + entry.file);
  if (!path) return path.error();
  const auto file = read_file(*path, kMaxPictureBytes);
  if (!file) return file.error();
  if (auto made = camera::picture_to_packet(*file, options_.deep, packet.bytes); !made)
    return at(path->string(), made.error());
  packet.source = options_.source;
  packet.channel = 0;
  packet.sequence = next_ - 1;
  packet.arrival = entry.stamp;
  packet.truncated = false;
  return Poll::kPacket;
}

Result<ImageFolderWriter> ImageFolderWriter::create(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / kPictures, error);
  if (error) return Error{Errc::kIo, "cannot create the folder", (folder / kPictures).string(), {}, error.message()};
  auto index = AppendFile::create(folder / "data.csv");
  if (!index) return index.error();
  if (auto header = index->append_line(kImageIndexHeader); !header) return header.error();
  camera::load_codecs();
  return ImageFolderWriter(folder / kPictures, std::move(*index));
}

Result<void> ImageFolderWriter::write(const Packet& packet) {
  if (last_ && packet.arrival <= *last_)
    return Error{Errc::kMalformed, "a picture's stamp does not increase", index_.path().string(), {}, {}};
  const auto frame = camera::parse_frame(packet.payload());
  if (!frame) return frame.error();
  const auto extension = camera::frame_to_picture(*frame, encoded_);
  if (!extension) return extension.error();
  const std::string name = std::to_string(packet.arrival.time_since_epoch().count()) + std::string(*extension);
  auto file = AppendFile::create(pictures_ / name);
  if (!file) return file.error();
  file->buffer() = encoded_;
  if (auto written = file->end_record(); !written) return written;
  // Waiting for the disk after every picture would hold a robot's recording up.
  if (auto closed = file->close(false); !closed) return closed;
  last_ = packet.arrival;
  return index_.append_line(to_csv(ImageIndexEntry{packet.arrival, name}));
}

}  // namespace cairn::recording
