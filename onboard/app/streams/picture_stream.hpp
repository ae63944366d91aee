// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "onboard/app/streams/client_hub.hpp"
#include "onboard/app/streams/outlets/picture_outlet.hpp"

namespace cairn::app {

/// Pictures of one camera on their way to the clients that want them: one at a time, in parts, over several ticks if
/// need be. A client that has not taken a picture when the next one is there loses the rest of it.
class PictureStream {
 public:
  /// `camera`: its number, below clients::CameraMessage::kMost.
  explicit PictureStream(std::uint8_t camera) : camera_(camera) {}
  /// Sends what clients take now, and takes what it sends off `records`: those of one tick, for all.
  /// `latency`: so much earlier than they arrived, pictures were taken.
  void serve(ClientHub& hub, SpscQueue<Packet>& pictures, Duration latency, std::size_t& records);

 private:
  void begin(ClientHub& hub, const Packet& picture);
  bool send(ClientHub& hub, StreamClient& client, const Packet& picture, std::size_t& records);

  std::uint8_t camera_;
  Duration latency_{};
  bool begun_ = false;             // the picture in front
  std::vector<std::byte> record_;  // reused
};

}  // namespace cairn::app
