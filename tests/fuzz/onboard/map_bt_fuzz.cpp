// SPDX-License-Identifier: Apache-2.0
// Any bytes are either an .bt map or an error.
#include "tests/fuzz/onboard/map_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto tree = cairn::mapping::decode_bt(cairn::mapping::as_bytes(data, size), cairn::mapping::kFuzzLimits);
  if (tree) cairn::mapping::check_accepted(**tree);
  return 0;
}
