// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/packet.hpp"

namespace cairn::app {

/// A picture as it came, not decoded. From receive to who looks at it.
struct ArrivedPicture {
  Packet packet;
};

}  // namespace cairn::app
