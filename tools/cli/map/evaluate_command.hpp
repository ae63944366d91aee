// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn evaluate trajectory|map ESTIMATE --ground-truth TRUTH`: errors against ground truth. `cairn evaluate
/// projection`: see tools/cli/projection.
void add_evaluate_command(app::Commands& commands);

}  // namespace cairn::cli
