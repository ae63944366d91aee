// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn label`: what the profile's networks say of the pictures of a recording.
void add_label_command(app::Commands& commands);

}  // namespace cairn::cli
