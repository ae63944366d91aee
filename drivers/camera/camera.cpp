// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/camera.hpp"

#include <algorithm>

#include "drivers/camera/convert.hpp"
#include "drivers/camera/picture_file.hpp"

namespace cairn::camera {

Result<StereoView> split_side_by_side(const ImageView& both) {
  if (both.width % 2 != 0) return Error{Errc::kMalformed, "a picture of two eyes has an odd width"};
  StereoView eyes{both, both};
  eyes.left.width = eyes.right.width = both.width / 2;
  if (!both.empty()) eyes.right.bytes = both.bytes.subspan(both.row(0).size() / 2);
  return eyes;
}

Result<void> left_eye(const Image& both, Image& left) {
  const auto eyes = split_side_by_side(both.view());
  if (!eyes) return eyes.error();
  left.source = both.source;
  left.sequence = both.sequence;
  left.stamp = both.stamp;
  left.start_of_exposure = both.start_of_exposure;
  left.resize(both.format, eyes->left.width, eyes->left.height);
  for (int y = 0; y < left.height; ++y) {
    const auto row = eyes->left.row(y);
    std::ranges::copy(row, left.bytes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * left.stride));
  }
  return {};
}

Result<Camera> Camera::create(const Config& config) {
  if (auto sound = check(config); !sound) return sound.error();
  load_codecs();
  return Camera(config);
}

Result<const Image*> Camera::decode(const Packet& packet) {
  if (last_sequence_ && packet.sequence <= *last_sequence_) {
    ++counters_.repeated;
    return Error{Errc::kMalformed, "a frame came twice or late"};
  }
  if (last_sequence_) counters_.lost += packet.sequence - *last_sequence_ - 1;
  last_sequence_ = packet.sequence;
  if (auto filled = fill(packet); !filled) {
    ++counters_.rejected;
    return filled.error();
  }
  ++counters_.frames;
  return &image_;
}

Result<void> Camera::fill(const Packet& packet) {
  if (packet.truncated) return Error{Errc::kTruncated, "the frame was cut off on its way"};
  const auto frame = parse_frame(packet.payload());
  if (!frame) return frame.error();
  image_.source = packet.source;
  image_.sequence = packet.sequence;
  image_.stamp = packet.arrival - latency_;
  image_.start_of_exposure = frame->header.start_of_exposure;
  return to_image(*frame, image_);
}

}  // namespace cairn::camera
