// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <span>

#include "onboard/mapping/files/cairn_file.hpp"
#include "onboard/mapping/files/octomap_file.hpp"

namespace cairn::mapping {

/// Small enough that a fuzzer with sanitisers stays fast.
inline constexpr MapLimits kFuzzLimits{std::uint64_t{16} << 20, std::uint64_t{1} << 20};

/// What must hold for whatever a reader accepted: the tree is canonical, both exact formats give it back, and the third
/// its likeliest state.
inline void check_accepted(const SemanticOcTree& tree) {
  if (!tree.is_canonical() || tree.size() != tree.calcNumNodes()) std::abort();
  const auto bytes = encode_cairn(tree);
  const auto back = decode_cairn(bytes);
  if (!back || encode_cairn(**back) != bytes) std::abort();
  const auto ot = encode_ot(tree);
  const auto from_ot = decode_ot(ot);
  if (!from_ot || encode_ot(**from_ot) != ot) std::abort();
  const auto bt = encode_bt(tree);
  const auto from_bt = decode_bt(bt);
  if (!from_bt || encode_bt(**from_bt) != bt) std::abort();
}

inline std::span<const std::byte> as_bytes(const unsigned char* data, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(data), size};
}

}  // namespace cairn::mapping
