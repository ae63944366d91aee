// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/clients/messages/wheels.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// What clients are told of the wheels. `radius_m`: of a wheel; 0: not known.
[[nodiscard]] clients::WheelsMessage message_of(const WheelNews& news, double radius_m);

}  // namespace cairn::app
