// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "drivers/clients/messages/camera.hpp"
#include "tools/ros/dds/topic.hpp"
#include "tools/ros/messages/pictures.hpp"

namespace cairn::ros {

/// One camera of the core as two topics: `NAME/image_raw/compressed` and `NAME/camera_info`, with the same stamps.
class CameraFeed {
 public:
  /// `at`: what comes before the camera's name in its topics, "/husky/". Errors: kIo.
  static Result<CameraFeed> open(RosParticipant& participant, const std::string& at,
                                 const clients::CameraMessage& camera);

  /// The core says anew how the camera sees.
  void describe(const clients::CameraMessage& camera) { camera_ = camera; }
  /// Errors: those of PictureCompressor.
  Result<void> take(const client::PictureMessage& picture, const Frames& frames, Duration utc_offset, Arena& arena);

  [[nodiscard]] const clients::CameraMessage& camera() const { return camera_; }
  [[nodiscard]] bool read_by_anybody() const { return image_.read_by_anybody() || info_.read_by_anybody(); }
  [[nodiscard]] std::uint64_t written() const { return image_.written(); }
  [[nodiscard]] std::uint64_t lost() const { return image_.lost() + info_.lost(); }

 private:
  CameraFeed(Writer<CompressedImage> image, Writer<CameraInfo> info, const clients::CameraMessage& camera)
      : image_(image), info_(info), camera_(camera) {}

  Writer<CompressedImage> image_;
  Writer<CameraInfo> info_;
  clients::CameraMessage camera_;
  PictureCompressor compressor_;
};

}  // namespace cairn::ros
