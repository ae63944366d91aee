// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include "hal/packet.hpp"
#include "hal/spsc_queue.hpp"

namespace cairn::app {

/// Cameras whose pictures clients can have: colour, thermal, depth.
inline constexpr std::size_t kShownCameras = 3;

/// The pictures of one camera, as it sent them. Two may wait, so a camera costs the memory of three pictures at most.
struct PictureOutlet {
  std::atomic<bool> wanted{false};  ///< a client wants them
  SpscQueue<Packet> pictures{2};    ///< from receive, while they are wanted
};

}  // namespace cairn::app
