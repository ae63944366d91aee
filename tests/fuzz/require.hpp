// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace cairn {

/// What must hold for any input: the fuzzer takes an abort for a finding.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace cairn
