// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn::app {

/// How often this thread has called operator new since it started. Counted in the `cairn` program and in the tests that
/// link this file; the figure goes into report.json and lets a test demand that a warm loop allocates nothing.
[[nodiscard]] std::uint64_t allocations_of_this_thread();

}  // namespace cairn::app
