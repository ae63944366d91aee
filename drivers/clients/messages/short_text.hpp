// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/bytes.hpp"

namespace cairn::clients {

/// Text of at most kMost bytes, without memory of its own. What is longer is cut.
template <std::size_t kMost>
class ShortText {
  static_assert(kMost < 256);

 public:
  ShortText() = default;
  explicit ShortText(std::string_view text) { append(text); }

  /// As much as still fits.
  ShortText& append(std::string_view text) {
    const std::size_t taken = std::min(text.size(), kMost - size_);
    std::copy_n(text.begin(), taken, text_.begin() + size_);
    size_ = static_cast<std::uint8_t>(size_ + taken);
    return *this;
  }
  [[nodiscard]] std::string_view view() const { return {text_.data(), size_}; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  friend bool operator==(const ShortText& a, const ShortText& b) { return a.view() == b.view(); }

 private:
  std::array<char, kMost> text_{};
  std::uint8_t size_ = 0;
};

/// Its length in a byte, then the text.
template <std::size_t kMost>
void append_text(std::vector<std::byte>& out, const ShortText<kMost>& text) {
  append_le(out, static_cast<std::uint8_t>(text.view().size()));
  for (const char c : text.view()) out.push_back(static_cast<std::byte>(c));
}

/// Printable ASCII and UTF-8 alone, so that a terminal may show it. Nothing: too long, cut, or other characters.
template <std::size_t kMost>
[[nodiscard]] std::optional<ShortText<kMost>> read_text(ByteReader& in) {
  const auto size = in.read<std::uint8_t>();
  if (!size || *size > kMost) return std::nullopt;
  const auto bytes = in.read_bytes(*size);
  if (!bytes) return std::nullopt;
  ShortText<kMost> text;
  for (const std::byte byte : *bytes) {
    const auto c = static_cast<unsigned char>(byte);
    if (c < 0x20 || c == 0x7F) return std::nullopt;
    const char letter = static_cast<char>(c);
    text.append({&letter, 1});
  }
  return text;
}

}  // namespace cairn::clients
