// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "drivers/clients/messages/camera.hpp"
#include "hal/image.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/client/picture_assembly.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// A camera's picture in the form of image_transport's compressed images: a JPEG for 8 bits a channel, a PNG for 16.
struct CompressedPicture {
  std::string format;            ///< as image_transport writes it: "bgr8; jpeg compressed bgr8"
  int width = 0, height = 0;     ///< pixels
  std::vector<std::byte> bytes;  ///< of the JPEG or PNG
};

/// Compresses pictures, and reuses its memory. A JPEG of a camera with one eye goes through as it came. Otherwise the
/// picture is the left eye's, without rows of telemetry.
class PictureCompressor {
 public:
  /// Valid until the next call. Errors: those of camera::parse_frame() and camera::to_image(); kMalformed where OpenCV
  /// cannot write the picture.
  Result<const CompressedPicture*> compress(const client::PictureMessage& picture,
                                            const clients::CameraMessage& camera);

 private:
  Result<void> encode();

  CompressedPicture out_;
  Image both_, left_;
};

/// REP-103's optical frame of a camera: x to the right, y down, z along the view.
[[nodiscard]] std::string optical_frame(const Frames& frames, const clients::CameraMessage& camera);
/// The turn from the camera's body frame (x along the view, y left, z up) to its optical frame.
[[nodiscard]] SE3 T_camera_optical();

[[nodiscard]] CompressedImage compressed_image_of(const CompressedPicture& picture, const Header& header, Arena& arena);

/// How the camera sees a picture of this size. All of K is 0, which means not calibrated, where the profile has no
/// numbers, or has them for another size. Distortions: plumb_bob, rational_polynomial or equidistant.
[[nodiscard]] CameraInfo camera_info_of(const clients::CameraMessage& camera, int width, int height,
                                        const Header& header, Arena& arena);

}  // namespace cairn::ros
