// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/camera/frame.hpp"
#include "hal/files/append_file.hpp"
#include "hal/ports.hpp"

// The pictures of one camera as EuRoC's data sets keep them: FOLDER/data.csv lists stamps and file names, the files are
// in FOLDER/data. Colour as PNG or JPEG, thermal as 16-bit PNG of raw counts (telemetry rows and all), depth as 16-bit
// PNG.
namespace cairn::recording {

inline constexpr std::size_t kMaxPictureBytes = std::size_t{64} << 20U;
inline constexpr std::string_view kImageIndexHeader = "#timestamp [ns],filename\n";

/// One line of data.csv.
struct ImageIndexEntry {
  Time stamp{};      ///< on the recording's time line
  std::string file;  ///< relative to the folder `data`
};

/// Reads data.csv: `stamp_ns,file`; lines starting with `#` are comments. Stamps must increase. Entries before a fault
/// are kept in `entries`; the Error names line and byte offset.
[[nodiscard]] Result<void> parse_image_index(std::string_view text, std::string_view name,
                                             std::vector<ImageIndexEntry>& entries);
[[nodiscard]] std::string to_csv(const ImageIndexEntry& entry);  ///< one line with its end

/// Replays such a folder. Each picture becomes the packet that a device would have sent (drivers/camera/frame.hpp),
/// with the stamp as its arrival and the place in the index as its sequence.
class ImageFolderSource final : public Source {
 public:
  /// How the folder is replayed.
  struct Options {
    SourceId source{};
    camera::FrameFormat deep = camera::FrameFormat::kY16;  ///< format of 16-bit pictures: kY16 or kZ16
  };
  /// Reads `dir`/`index`, such as camera/data.csv. With a damaged index the entries before the damage are handed out,
  /// then the error once.
  [[nodiscard]] static Result<std::unique_ptr<ImageFolderSource>> open(std::filesystem::path dir,
                                                                       const std::string& index,
                                                                       const Options& options);

  /// Never waits. A picture that cannot be read is one error, and the next call goes on with the next picture.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const std::vector<ImageIndexEntry>& entries() const { return entries_; }

 private:
  ImageFolderSource(std::filesystem::path dir, std::string pictures, const Options& options)
      : dir_(std::move(dir)), pictures_(std::move(pictures)), options_(options) {}

  std::filesystem::path dir_;
  std::string pictures_;  // the folder of the pictures, relative to dir_, with '/' at its end
  Options options_;
  std::vector<ImageIndexEntry> entries_;
  std::optional<Error> damage_;
  std::size_t next_ = 0;
};

/// Writes such a folder from packets with frames. JPEGs are kept as they are. Other formats become PNG with the same
/// pixels (YUV is converted to colour). A picture is in the index only if its file is whole.
class ImageFolderWriter {
 public:
  /// Makes `folder`, its data.csv (an old one is emptied) and `folder`/data.
  [[nodiscard]] static Result<ImageFolderWriter> create(const std::filesystem::path& folder);

  /// Errors: those of decoding the frame; kMalformed when the stamp does not increase; kIo. What was written is kept.
  [[nodiscard]] Result<void> write(const Packet& packet);
  /// Hands the index to the operating system; call it about once a second.
  [[nodiscard]] Result<void> flush() { return index_.flush(); }
  [[nodiscard]] Result<void> close() { return index_.close(); }

 private:
  ImageFolderWriter(std::filesystem::path pictures, AppendFile index)
      : pictures_(std::move(pictures)), index_(std::move(index)) {}

  std::filesystem::path pictures_;
  AppendFile index_;
  std::optional<Time> last_;
  std::vector<std::byte> encoded_;
};

}  // namespace cairn::recording
