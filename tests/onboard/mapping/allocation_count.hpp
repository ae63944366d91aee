// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn {

/// Calls of operator new in this program so far, by any thread.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace cairn
