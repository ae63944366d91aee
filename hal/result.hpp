// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace cairn {

/// The kind of an Error, for code that reacts to it.
enum class Errc : std::uint8_t {
  kIo,             ///< the system refused (open, read, write, bind)
  kNotFound,       ///< the file, device or key is not there
  kMalformed,      ///< the bytes are not what they claim to be
  kTruncated,      ///< the bytes end before they should
  kUnsupported,    ///< understood, but not implemented for this variant
  kLimit,          ///< a bound on memory, depth, count or size was reached
  kInvalidConfig,  ///< one or more faults in a configuration; `detail` has all of them
  kDiverged,       ///< an estimate did not converge
  kLinkDown,       ///< the device or peer does not answer
};

/// An error that is expected at run time: what went wrong, where, and what to do about it.
/// Making one from literals does not allocate, so real-time code may do it.
struct Error {
  Errc code{};
  std::string_view cause;                 ///< static storage: what is wrong
  std::string where{};                    ///< file, device or key; empty if the caller adds it
  std::optional<std::uint64_t> offset{};  ///< bytes from the start of `where`
  std::string detail{};                   ///< the values seen, and the remedy
};

/// "where: offset 12: cause: detail", leaving out what is empty.
[[nodiscard]] inline std::string to_string(const Error& e) {
  std::string text;
  if (!e.where.empty()) text += e.where + ": ";
  if (e.offset) text += "offset " + std::to_string(*e.offset) + ": ";
  text += e.cause;
  if (!e.detail.empty()) text += ": " + e.detail;
  return text;
}

/// A value or an Error: tl::expected that the compiler does not let you ignore.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Error> {
  using Base = tl::expected<T, Error>;

 public:
  using Base::Base;
  Result(Error error) : Base(tl::unexpected<Error>(std::move(error))) {}  // NOLINT(google-explicit-constructor)
};

/// The error with the place where it happened, if it has none yet. For callers that know the name of the file.
[[nodiscard]] inline Error at(std::string where, Error error) {
  if (error.where.empty()) error.where = std::move(where);
  return error;
}

}  // namespace cairn
