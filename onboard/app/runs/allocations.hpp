// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn::app {

/// How often this thread has called operator new since it started. Programs that link this file count it. The figure is
/// in report.json, and tests demand with it that a warm loop allocates nothing.
[[nodiscard]] std::uint64_t allocations_of_this_thread();

}  // namespace cairn::app
