// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::faults {

/// From forbid_calls() until allow_calls(), a call of malloc, calloc, realloc, an aligned allocation or anything that
/// may block on a lock (pthread mutexes, read-write locks, conditions, semaphores, futexes) on this thread aborts the
/// program and says which it was.
void forbid_calls();
void allow_calls();
/// How many such calls there were on this thread while they were allowed: shows that they are seen at all.
[[nodiscard]] long calls_seen();

}  // namespace cairn::faults
