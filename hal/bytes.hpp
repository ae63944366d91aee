// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace cairn {

static_assert(std::endian::native == std::endian::little, "Cairn runs on little-endian machines only");

/// A little-endian value at `offset`. The caller has checked that offset + sizeof(T) <= bytes.size().
template <class T>
[[nodiscard]] T load_le(std::span<const std::byte> bytes, std::size_t offset) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Reads untrusted bytes from front to back. Every step is checked, so none can go past the end.
class ByteReader {
 public:
  /// The bytes belong to the caller and must outlive the reader.
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t offset() const { return offset_; }  ///< bytes read so far
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - offset_; }

  /// The next little-endian value; null when fewer bytes are left.
  template <class T>
  [[nodiscard]] std::optional<T> read() {
    if (remaining() < sizeof(T)) return std::nullopt;
    const T value = load_le<T>(bytes_, offset_);
    offset_ += sizeof(T);
    return value;
  }
  /// The next `n` bytes, in the caller's memory; null when fewer are left.
  [[nodiscard]] std::optional<std::span<const std::byte>> read_bytes(std::uint64_t n) {
    if (remaining() < n) return std::nullopt;
    const auto part = bytes_.subspan(offset_, static_cast<std::size_t>(n));
    offset_ += part.size();
    return part;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
};

/// Appends a little-endian value.
template <class T>
void append_le(std::vector<std::byte>& out, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}

}  // namespace cairn
