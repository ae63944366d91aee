// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace cairn::networks {

/// What a TensorProto of an ONNX file says of itself, and how much it holds.
struct OnnxWeights {
  std::string_view name;
  std::uint64_t elements = 1;  ///< that its shape says; at most kMostElements + 1
  std::uint64_t type = 0;      ///< TensorProto.DataType
  bool external = false;       ///< the values are in another file
  bool has_raw = false;
  std::uint64_t raw_bytes = 0, floats = 0, int32s = 0, int64s = 0, doubles = 0;  ///< that it holds

  static constexpr std::uint64_t kMostElements = std::uint64_t{1} << 28U;
  /// Whether it holds as many values as its shape says. OpenCV reads them without asking. True for types that OpenCV
  /// refuses.
  [[nodiscard]] bool complete() const;
};

/// False: the bytes are no such message.
[[nodiscard]] bool parse_onnx_weights(std::string_view bytes, OnnxWeights& weights);

}  // namespace cairn::networks
