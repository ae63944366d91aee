// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/clients/messages/state.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// Brings the message up to date, but for its stamp and map. True: what clients are told at once has changed; a further
/// scan is nothing of the kind.
bool update(const StateNews& news, clients::StateMessage& message);

}  // namespace cairn::app
