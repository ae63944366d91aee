// SPDX-License-Identifier: Apache-2.0
// Any bytes as an ONNX file: its description is bounded and has one input.
#include "onboard/perception/networks/model/onnx_header.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto header = networks::parse_onnx_header({reinterpret_cast<const std::byte*>(data), size});
  if (!header) return 0;
  require(header->inputs.size() == 1 && !header->outputs.empty() && header->outputs.size() <= 64);
  for (const auto& tensor : header->outputs) require(!networks::shape_text(tensor.shape).empty());
  return 0;
}
