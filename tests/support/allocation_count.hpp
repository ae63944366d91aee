// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace cairn::support {

/// Calls of operator new in this program so far, by any thread.
[[nodiscard]] std::size_t allocation_count();

}  // namespace cairn::support
