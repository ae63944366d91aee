// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn evaluate detectors RUN… --ground-truth RECORDING…`: how far the detectors of people can be trusted, counted
/// in runs of simulated recordings, as keys of a profile. `evaluate`: the command that it belongs to.
void add_evaluate_detectors_command(app::Commands& commands, CLI::App& evaluate);

}  // namespace cairn::cli
