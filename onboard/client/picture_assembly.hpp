// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/picture.hpp"

namespace cairn::client {

/// A whole picture, as its camera sent it.
struct PictureMessage {
  Time stamp{};                  ///< see clients::PicturePart
  std::uint8_t camera = 0;       ///< see clients::CameraMessage
  std::vector<std::byte> bytes;  ///< of drivers/camera/frame.hpp: a header, then the pixels
};

/// Makes pictures of their parts, for each camera by itself. A picture of which a part is missing is left out. Memory
/// is bounded by clients::PicturePart::kMaxBytes for each camera.
class PictureAssembly {
 public:
  /// The picture that this part completes, if it does.
  [[nodiscard]] std::optional<PictureMessage> take(clients::PicturePart part);

 private:
  std::array<std::optional<PictureMessage>, clients::CameraMessage::kMost> pictures_;
};

}  // namespace cairn::client
