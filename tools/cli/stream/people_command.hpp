// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn people`: where the people around a running robot are.
void add_people_command(app::Commands& commands);

}  // namespace cairn::cli
