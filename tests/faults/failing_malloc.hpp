// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::faults {

/// From now on the n-th call of operator new by this thread (0: the next) finds no memory; once. Negative: never.
void fail_allocation(long n);
/// Whether it has come to that.
[[nodiscard]] bool allocation_failed();

}  // namespace cairn::faults
