// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/picture_assembly.hpp"

#include <utility>

namespace cairn::client {

std::optional<PictureMessage> PictureAssembly::take(clients::PicturePart part) {
  if (part.camera >= pictures_.size()) return std::nullopt;
  auto& picture = pictures_[part.camera];
  if (part.first == 0) picture = PictureMessage{.stamp = part.stamp, .camera = part.camera, .bytes = {}};
  const bool follows = picture && picture->stamp == part.stamp && picture->bytes.size() == part.first;
  if (!follows) {
    picture.reset();
    return std::nullopt;
  }
  picture->bytes.insert(picture->bytes.end(), part.bytes.begin(), part.bytes.end());
  if (picture->bytes.size() < part.total) return std::nullopt;
  return std::exchange(picture, std::nullopt);
}

}  // namespace cairn::client
