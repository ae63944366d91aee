// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/protocol/methods/outcome.hpp"

namespace cairn::protocol {

/// One claim of the book, or one goal of Cairn, and the figure of this run for it.
struct Claim {
  std::string claim;
  std::string figures;  ///< by which it holds or does not
  bool holds = false;
  bool books = false;  ///< the book says so
};

/// The claims for which the outcome has the runs.
[[nodiscard]] std::vector<Claim> claims_of(const Outcome& outcome);

}  // namespace cairn::protocol
