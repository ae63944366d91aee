// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace cairn::support {

/// Whether a sanitiser watches this program. It then takes ten to twenty times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitised = true;
#elif defined(__has_feature)
inline constexpr bool kSanitised = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitised = false;
#endif

/// How often a law is tried, or on how much: all of it, and a part where a sanitiser watches. A part touches the same
/// memory in the same ways. `.ci/run --full` sets CAIRN_ALL_ROUNDS, for all of it.
inline int rounds(int all, int watched) {
  return kSanitised && std::getenv("CAIRN_ALL_ROUNDS") == nullptr ? watched : all;
}

}  // namespace cairn::support
