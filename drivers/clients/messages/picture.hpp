// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// A part of a picture, as its camera sent it. The parts of one picture follow each other; between them there may be
/// parts of pictures of other cameras. The bytes are those of drivers/camera/frame.hpp: a header, then the pixels.
struct PicturePart {
  static constexpr RecordKind kKind = RecordKind::kPicture;
  static constexpr std::uint32_t kMaxBytes = 1U << 24U;  ///< of a picture; larger ones are not sent

  Time stamp{};                    ///< when it was taken, as far as the camera's latency is known
  std::uint8_t camera = 0;         ///< see CameraMessage
  std::uint32_t total = 0;         ///< bytes of the whole picture
  std::uint32_t first = 0;         ///< how many came before
  std::vector<std::byte> bytes{};  ///< these
};

/// Appends the body of a part of `bytes`, from `part.first` on, as many as fit. Returns how many these are. The body
/// is: stamp (8), camera (1), zeros (3), total (4), first (4), bytes. `part.total` and `part.bytes` do not matter.
std::uint32_t encode(const PicturePart& part, std::span<const std::byte> bytes, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<PicturePart> decode_picture(std::span<const std::byte> body);

}  // namespace cairn::clients
