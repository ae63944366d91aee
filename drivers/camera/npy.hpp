// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

#include "drivers/camera/frame.hpp"
#include "hal/ports.hpp"

namespace cairn::camera {

/// What a NumPy file of pictures holds (numpy.lib.format, versions 1 to 3): an array in C order of shape (height,
/// width) or (frames, height, width), of little-endian u16 or u8.
struct NpyHeader {
  std::size_t data_offset = 0;  ///< bytes from the file's start
  std::uint64_t frames = 0;
  std::uint32_t height = 0, width = 0;
  std::uint32_t pixel_bytes = 0;  ///< 1 or 2

  [[nodiscard]] std::uint64_t frame_bytes() const { return std::uint64_t{height} * width * pixel_bytes; }
};

inline constexpr std::size_t kMaxNpyHeaderBytes = 4096;

/// `start` are the first bytes of the file; kMaxNpyHeaderBytes always suffice. Errors: kMalformed, kTruncated,
/// kUnsupported (other types, other orders), kLimit (pictures that no camera makes).
[[nodiscard]] Result<NpyHeader> parse_npy_header(std::span<const std::byte> start);

/// Replays the pictures of a .npy file, as a camera would have sent them. The file knows no times: they come at a
/// constant rate.
class NpySource final : public Source {
 public:
  struct Options {
    SourceId source{};
    FrameFormat deep = FrameFormat::kY16;  ///< what two bytes are: kY16 or kZ16; one byte is kGrey
    double rate_hz = 9;
    Time start{};
  };
  /// Errors: kNotFound, kIo and those of parse_npy_header(); kTruncated when not even one picture is there.
  [[nodiscard]] static Result<std::unique_ptr<NpySource>> open(const std::filesystem::path& path,
                                                               const Options& options);

  /// A file that ends early is one Error at its end. Never waits.
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
