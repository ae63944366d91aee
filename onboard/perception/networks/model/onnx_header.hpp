// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace cairn::networks {

/// Name and shape of an input or output of a network.
struct OnnxTensor {
  std::string name;
  std::vector<std::int64_t> shape;  ///< 0: the model leaves this size open
};

/// What an ONNX file says of itself.
struct OnnxHeader {
  std::int64_t opset = 0;  ///< of the standard operators
  std::string producer;
  std::vector<OnnxTensor> inputs, outputs;
};

/// Reads an ONNX file (a protobuf message ModelProto, onnx.proto3) as far as it describes itself. It walks over the
/// whole file once, so a file that is cut off is seen. Errors: kTruncated; kMalformed (no ONNX, or not one input);
/// kLimit; kUnsupported (the weights are in another file).
[[nodiscard]] Result<OnnxHeader> parse_onnx_header(std::span<const std::byte> file);

/// "1x3x416x416"; an open size is "?".
[[nodiscard]] std::string shape_text(std::span<const std::int64_t> shape);

}  // namespace cairn::networks
