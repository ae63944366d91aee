// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/bytes.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// Reads the fields of a body from front to back. After the first field that is missing or wrong, all further ones are
/// zero; error() says so at the end.
class FieldReader {
 public:
  /// `body` must outlive the reader.
  explicit FieldReader(std::span<const std::byte> body) : in_(body) {}

  template <class T>
  [[nodiscard]] T number() {
    const auto value = good_ ? in_.read<T>() : std::nullopt;
    good_ = value.has_value();
    return value.value_or(T{});
  }
  /// One of 0 … `most`.
  template <class T>
  [[nodiscard]] T up_to(T most) {
    const T value = number<T>();
    require(value <= most);
    return good_ ? value : T{};
  }
  /// A finite number whose absolute value is `most` at most.
  [[nodiscard]] double real(double most = 1e12) {
    const double value = number<double>();
    require(std::isfinite(value) && std::abs(value) <= most);
    return good_ ? value : 0;
  }
  [[nodiscard]] Time time() { return Time{Duration{number<std::int64_t>()}}; }
  /// Length (1 byte), then so many bytes of any kind.
  [[nodiscard]] std::string text(std::size_t most);
  /// x y z qx qy qz qw; the quaternion has length 1.
  [[nodiscard]] SE3 pose();
  /// The next `n` bytes, in the caller's memory; empty once something was wrong.
  [[nodiscard]] std::span<const std::byte> bytes(std::size_t n) {
    const auto part = good_ ? in_.read_bytes(n) : std::nullopt;
    good_ = part.has_value();
    return part.value_or(std::span<const std::byte>{});
  }

  /// What has to hold of the fields so far.
  void require(bool holds) { good_ = good_ && holds; }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::size_t remaining() const { return in_.remaining(); }
  /// All fields were right and nothing is left over.
  [[nodiscard]] bool complete() const { return good_ && in_.remaining() == 0; }
  /// kMalformed, for a body that was not complete(). `cause`: a literal.
  [[nodiscard]] Error error(std::string_view cause) const { return {Errc::kMalformed, cause, {}, in_.offset(), {}}; }

 private:
  ByteReader in_;
  bool good_ = true;
};

/// As FieldReader::text() reads it. Longer text is cut, not in the middle of a UTF-8 character.
void append_text(std::vector<std::byte>& out, std::string_view text, std::size_t most);
/// As FieldReader::pose() reads it.
void append_pose(std::vector<std::byte>& out, const SE3& pose);
inline void append_time(std::vector<std::byte>& out, Time time) {
  append_le(out, static_cast<std::int64_t>(time.time_since_epoch().count()));
}

}  // namespace cairn::clients
