// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn evaluate people RUN --ground-truth RECORDING`: how well a run followed the people of a simulated recording.
/// `evaluate`: the command that it belongs to.
void add_evaluate_people_command(app::Commands& commands, CLI::App& evaluate);

}  // namespace cairn::cli
