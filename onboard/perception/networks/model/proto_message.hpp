// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/result.hpp"

// The wire format of protobuf, as far as reading a model's description needs it. Nothing is copied.
namespace cairn::networks {

/// One field of a message: a number, or bytes.
struct ProtoField {
  std::uint32_t number = 0;
  bool packed = false;      ///< it has bytes
  std::uint64_t value = 0;  ///< otherwise; 0 for numbers of fixed size, which are skipped
  std::string_view bytes;   ///< of a text, a message inside, or several numbers
};

/// Walks over the fields of one protobuf message. It ends early where the bytes are no message.
class ProtoMessage {
 public:
  explicit ProtoMessage(std::string_view bytes) : bytes_(bytes) {}

  std::optional<ProtoField> next() {
    if (at_ == bytes_.size() || fault_) return std::nullopt;
    const auto key = varint();
    if (!key) return std::nullopt;
    ProtoField field;
    field.number = static_cast<std::uint32_t>(*key >> 3U);
    if (field.number == 0 || *key >> 32U != 0) return fail(Errc::kMalformed);
    switch (*key & 7U) {
      case 0:
        field.value = varint().value_or(0);
        break;
      case 1:
        take(8);
        break;
      case 2:
        field.packed = true;
        field.bytes = take(varint().value_or(0));
        break;
      case 5:
        take(4);
        break;
      default:
        return fail(Errc::kMalformed);
    }
    if (fault_) return std::nullopt;
    return field;
  }
  [[nodiscard]] std::optional<Errc> fault() const { return fault_; }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::optional<ProtoField> fail(Errc code) {
    fault_ = code;
    return std::nullopt;
  }
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      if (at_ == bytes_.size()) {
        fault_ = Errc::kTruncated;
        return std::nullopt;
      }
      const auto byte = static_cast<unsigned char>(bytes_[at_++]);
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80U) return value;
    }
    fault_ = Errc::kMalformed;
    return std::nullopt;
  }
  std::string_view take(std::uint64_t size) {
    if (fault_) return {};
    if (size > bytes_.size() - at_) {
      fault_ = Errc::kTruncated;
      return {};
    }
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += taken.size();
    return taken;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::optional<Errc> fault_;
};

/// Calls `take` for each field. False: the bytes are no message, or `take` says so.
template <class Take>
bool each_field(std::string_view bytes, Take take) {
  ProtoMessage message(bytes);
  while (const auto field = message.next())
    if (!take(*field)) return false;
  return !message.fault();
}

}  // namespace cairn::networks
