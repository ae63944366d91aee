// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/clients/messages/people.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// What clients are told of people.
[[nodiscard]] clients::PeopleMessage message_of(const PeopleNews& news);

}  // namespace cairn::app
