// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace cairn::cli {

/// One thing that the doctor looked at.
struct Finding {
  enum class Level {
    kOk,
    kNote,     ///< works, but not as well as it could
    kProblem,  ///< does not work
  };
  Level level = Level::kOk;
  std::string what;
  std::string remedy;  ///< empty where nothing has to be done
};
using Findings = std::vector<Finding>;

}  // namespace cairn::cli
