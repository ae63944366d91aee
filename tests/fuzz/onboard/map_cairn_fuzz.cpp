// SPDX-License-Identifier: Apache-2.0
// Any bytes are either a .cairn map or an error. A fuzzer does not guess checksums: the same bytes are also tried as
// the content of the only chunk of a file in which all of them are right.
#include <zstd.h>

#include <algorithm>

#include "hal/bytes.hpp"
#include "onboard/mapping/files/cairn_format.hpp"
#include "tests/fuzz/onboard/map_fuzz.hpp"

namespace {

using namespace cairn;

std::vector<std::byte> file_around(std::span<const std::byte> raw, std::uint64_t nodes) {
  std::vector<std::byte> frame(ZSTD_compressBound(raw.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 1));
  const mapping::cairn_format::Chunk chunk{static_cast<std::uint32_t>(raw.size()),
                                           static_cast<std::uint32_t>(frame.size()),
                                           mapping::cairn_format::hash(frame)};
  return mapping::cairn_format::assemble({0.1, mapping::SemanticOcTree(0.1).sensor_model(), nodes, {}, {chunk}, 0},
                                         frame);
}

void check(std::span<const std::byte> bytes) {
  const auto tree = mapping::decode_cairn(bytes, mapping::kFuzzLimits);
  if (tree) mapping::check_accepted(**tree);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto bytes = mapping::as_bytes(data, size);
  check(bytes);
  if (size < 4) return 0;
  const auto nodes = load_le<std::uint32_t>(bytes, 0);
  check(file_around(bytes.subspan(4), nodes));
  return 0;
}
