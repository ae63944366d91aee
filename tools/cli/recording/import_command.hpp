// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn import KIND SRC --out DIR`: makes a recording of other data.
void add_import_command(app::Commands& commands);

}  // namespace cairn::cli
