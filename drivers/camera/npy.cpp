// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/npy.hpp"

#include <array>
#include <charconv>
#include <string_view>

#include "hal/bytes.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::camera {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// What follows "'key':" in the header's dictionary, to its end.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
  const std::size_t at = dictionary.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = trimmed(dictionary.substr(at + key.size()));
  return rest.starts_with(':') ? trimmed(rest.substr(1)) : std::string_view{};
}

/// "(161, 120, 160)" → dimensions; none when it is anything but two or three numbers.
std::optional<std::array<std::uint64_t, 3>> parse_shape(std::string_view text) {
  const std::size_t end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos) return std::nullopt;
  text = text.substr(1, end - 1);
  std::array<std::uint64_t, 3> shape{};
  std::size_t n = 0;
  while (!(text = trimmed(text)).empty()) {
    if (n == shape.size()) return std::nullopt;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), shape[n]);
    if (error != std::errc{}) return std::nullopt;
    text = trimmed(text.substr(static_cast<std::size_t>(stop - text.data())));
    if (!text.empty() && text.front() != ',') return std::nullopt;
    if (!text.empty()) text.remove_prefix(1);
    ++n;
  }
  if (n == 2) return std::array<std::uint64_t, 3>{1, shape[0], shape[1]};
  return n == 3 ? std::optional(shape) : std::nullopt;
}

Result<NpyHeader> parse_dictionary(std::string_view text) {
  NpyHeader header;
  const std::string_view type = value_of(text, "'descr'");
  if (type.starts_with("'<u2'")) header.pixel_bytes = 2;
  if (type.starts_with("'|u1'")) header.pixel_bytes = 1;
  if (header.pixel_bytes == 0)
    return Error{
        Errc::kUnsupported, "the array is neither little-endian u16 nor u8", {}, {}, std::string(type.substr(0, 12))};
  if (!value_of(text, "'fortran_order'").starts_with("False"))
    return Error{Errc::kUnsupported, "the array is not in C order"};
  const auto shape = parse_shape(value_of(text, "'shape'"));
  if (!shape) return Error{Errc::kUnsupported, "the array's shape is not (height, width) or (frames, height, width)"};
  const auto [frames, height, width] = *shape;
  if (height == 0 || width == 0) return Error{Errc::kMalformed, "the array's pictures have no pixels"};
  if (height > kMaxSide || width > kMaxSide || height * width > kMaxPixels || frames > (std::uint64_t{1} << 32U))
    return Error{Errc::kLimit, "the array's pictures are larger than any camera's"};
  header.frames = frames;
  header.height = static_cast<std::uint32_t>(height);
  header.width = static_cast<std::uint32_t>(width);
  return header;
}

/// The header's text, and where it ends in the file.
struct Dictionary {
  std::string_view text;
  std::size_t end = 0;
};

Result<Dictionary> read_dictionary(std::span<const std::byte> start) {
  ByteReader in(start);
  const auto magic = in.read_bytes(kMagic.size());
  if (!magic || std::string_view(reinterpret_cast<const char*>(magic->data()), magic->size()) != kMagic)
    return Error{Errc::kMalformed, "not a .npy file", {}, 0, {}};
  const auto major = in.read<std::uint8_t>();
  const auto minor = in.read<std::uint8_t>();
  if (!major || !minor) return Error{Errc::kTruncated, ".npy header is cut off"};
  if (*major < 1 || *major > 3) return Error{Errc::kUnsupported, "unknown version of .npy", {}, 6, {}};
  std::optional<std::uint32_t> length;
  if (*major == 1) {
    if (const auto l = in.read<std::uint16_t>()) length = *l;
  } else {
    length = in.read<std::uint32_t>();
  }
  const auto text = length ? in.read_bytes(*length) : std::nullopt;
  if (!text) return Error{Errc::kTruncated, ".npy header is cut off or longer than any", {}, in.offset(), {}};
  return Dictionary{{reinterpret_cast<const char*>(text->data()), text->size()}, in.offset()};
}

}  // namespace

Result<NpyArray> parse_npy_array(std::span<const std::byte> start) {
  const auto dictionary = read_dictionary(start);
  if (!dictionary) return dictionary.error();
  const auto [text, offset] = *dictionary;
  const auto until = [](std::string_view value, char first, char last) {
    const std::size_t end = value.find(last, 1);
    const bool whole = value.starts_with(first) && end != std::string_view::npos;
    return std::string(whole ? value.substr(0, end + 1) : value.substr(0, value.find_first_of(",}")));
  };
  NpyArray array{
      .data_offset = offset, .type = until(value_of(text, "'descr'"), '\'', '\''), .shape = {}, .c_order = true};
  array.shape = until(value_of(text, "'shape'"), '(', ')');
  array.c_order = !value_of(text, "'fortran_order'").starts_with("True");
  if (array.type.empty() || array.shape.empty()) return Error{Errc::kMalformed, "the .npy header has no type or shape"};
  return array;
}

Result<NpyHeader> parse_npy_header(std::span<const std::byte> start) {
  const auto dictionary = read_dictionary(start);
  if (!dictionary) return dictionary.error();
  auto header = parse_dictionary(dictionary->text);
  if (header) header->data_offset = dictionary->end;
  return header;
}

Result<std::unique_ptr<NpySource>> NpySource::open(const std::filesystem::path& path, const Options& options) {
  auto opened = open_input_stream(path);
  if (!opened) return opened.error();
  std::ifstream file = std::move(*opened);
  std::array<std::byte, kMaxNpyHeaderBytes> start{};
  file.read(reinterpret_cast<char*>(start.data()), start.size());
  const auto header = parse_npy_header(std::span(start).first(static_cast<std::size_t>(file.gcount())));
  if (!header) return at(path.string(), header.error());
  file.clear();
  file.seekg(static_cast<std::streamoff>(header->data_offset));
  return std::unique_ptr<NpySource>(new NpySource(std::move(file), path.string(), *header, options));
}

Result<Poll> NpySource::next(Packet& packet, Duration) {
  if (next_ == header_.frames) return Poll::kEnd;
  const FrameFormat format = header_.pixel_bytes == 1 ? FrameFormat::kGrey : options_.deep;
  packet.source = options_.source;
  packet.channel = 0;
  packet.sequence = next_;
  packet.arrival = options_.start + from_seconds(static_cast<double>(next_) / options_.rate_hz);
  packet.truncated = false;
  packet.bytes.clear();
  append_header(packet.bytes, {static_cast<std::uint32_t>(format), header_.width, header_.height,
                               header_.width * header_.pixel_bytes, false});
  packet.bytes.resize(kFrameHeaderBytes + header_.frame_bytes());
  file_.read(reinterpret_cast<char*>(packet.bytes.data() + kFrameHeaderBytes),
             static_cast<std::streamsize>(header_.frame_bytes()));
  if (file_) return ++next_, Poll::kPacket;
  const std::uint64_t whole = std::exchange(next_, header_.frames);
  return Error{Errc::kTruncated, "the file ends inside a picture", name_,
               header_.data_offset + whole * header_.frame_bytes(),
               "after " + std::to_string(whole) + " of " + std::to_string(header_.frames)};
}

}  // namespace cairn::camera
