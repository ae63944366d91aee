// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/bridge/camera_feed.hpp"

#include "tools/ros/dds/ros_name.hpp"

namespace cairn::ros {

Result<CameraFeed> CameraFeed::open(RosParticipant& participant, const std::string& at,
                                    const clients::CameraMessage& camera) {
  const std::string base = at + namespace_of(camera.name);
  const auto image = Writer<CompressedImage>::open(participant, base + "/image_raw/compressed", TopicUse::kStream);
  const auto info = Writer<CameraInfo>::open(participant, base + "/camera_info", TopicUse::kStream);
  if (!image) return image.error();
  if (!info) return info.error();
  return CameraFeed(*image, *info, camera);
}

Result<void> CameraFeed::take(const client::PictureMessage& picture, const Frames& frames, Duration utc_offset,
                              Arena& arena) {
  const auto compressed = compressor_.compress(picture, camera_);
  if (!compressed) return compressed.error();
  const CompressedPicture& small = **compressed;
  const Header header = header_of(picture.stamp, utc_offset, optical_frame(frames, camera_), arena);
  (void)image_.write(compressed_image_of(small, header, arena));
  (void)info_.write(camera_info_of(camera_, small.width, small.height, header, arena));
  return {};
}

}  // namespace cairn::ros
