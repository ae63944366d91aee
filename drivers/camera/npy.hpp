// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "drivers/camera/frame.hpp"
#include "hal/ports.hpp"

namespace cairn::camera {

/// A NumPy file of pictures (numpy.lib.format, versions 1 to 3): an array in C order of shape (height, width) or
/// (frames, height, width), of little-endian u16 or u8.
struct NpyHeader {
  std::size_t data_offset = 0;  ///< bytes from the file's start
  std::uint64_t frames = 0;
  std::uint32_t height = 0, width = 0;
  std::uint32_t pixel_bytes = 0;  ///< 1 or 2

  /// Bytes of one picture.
  [[nodiscard]] std::uint64_t frame_bytes() const { return std::uint64_t{height} * width * pixel_bytes; }
};

inline constexpr std::size_t kMaxNpyHeaderBytes = 4096;

/// Any NumPy file: what its header says, unread.
struct NpyArray {
  std::size_t data_offset = 0;  ///< bytes from the file's start
  std::string type;             ///< of a value, such as "<f4"
  std::string shape;            ///< such as "(3, 4)"
  bool c_order = true;
};

/// `start` as below. Errors: kMalformed, kTruncated, kUnsupported (another version).
[[nodiscard]] Result<NpyArray> parse_npy_array(std::span<const std::byte> start);

/// `start` holds the first bytes of the file; kMaxNpyHeaderBytes are always enough. Errors: kMalformed, kTruncated,
/// kUnsupported (other types, other orders), kLimit (pictures larger than any camera's).
[[nodiscard]] Result<NpyHeader> parse_npy_header(std::span<const std::byte> start);

/// Replays the pictures of a .npy file as if a camera had sent them. The file has no times, so the rate is constant.
class NpySource final : public Source {
 public:
  /// How the pictures are replayed.
  struct Options {
    SourceId source{};
    FrameFormat deep = FrameFormat::kY16;  ///< format of pixels of two bytes: kY16 or kZ16; one byte is kGrey
    double rate_hz = 9;                    ///< pictures per second
    Time start{};                          ///< arrival of the first picture
  };
  /// Errors: those of InputFile::open() and parse_npy_header(); kTruncated when not even one picture is there.
  [[nodiscard]] static Result<std::unique_ptr<NpySource>> open(const std::filesystem::path& path,
                                                               const Options& options);

  /// Never waits. A file that ends early gives one Error at its end.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const NpyHeader& header() const { return header_; }

 private:
  NpySource(std::ifstream file, std::string name, const NpyHeader& header, const Options& options)
      : file_(std::move(file)), name_(std::move(name)), header_(header), options_(options) {}

  std::ifstream file_;
  std::string name_;
  NpyHeader header_;
  Options options_;
  std::uint64_t next_ = 0;
};

}  // namespace cairn::camera
