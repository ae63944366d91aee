// SPDX-License-Identifier: Apache-2.0
#include <linux/videodev2.h>

#include "drivers/camera/v4l2_stream.hpp"

namespace cairn::camera {
namespace {

void add_sizes(V4l2Calls& calls, int fd, std::uint32_t format, std::vector<OfferedMode>& modes) {
  for (std::uint32_t i = 0; modes.size() < kMaxModes; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = format;
    if (calls.ioctl(fd, VIDIOC_ENUM_FRAMESIZES, &size) < 0) return;
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
      modes.push_back({format, size.stepwise.max_width, size.stepwise.max_height});
      return;  // a range is the only entry
    }
    modes.push_back({format, size.discrete.width, size.discrete.height});
  }
}

}  // namespace

std::vector<OfferedMode> offered_modes(V4l2Calls& calls, int fd) {
  std::vector<OfferedMode> modes;
  for (std::uint32_t i = 0; i < kMaxModes; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (calls.ioctl(fd, VIDIOC_ENUM_FMT, &format) < 0) break;
    add_sizes(calls, fd, format.pixelformat, modes);
  }
  return modes;
}

std::vector<OfferedMode> offered_modes(V4l2Calls& calls, const std::string& device) {
  const int fd = calls.open(device.c_str());
  if (fd < 0) return {};
  auto modes = offered_modes(calls, fd);
  calls.close(fd);
  return modes;
}

std::string to_string(std::span<const OfferedMode> modes) {
  std::string text;
  std::uint32_t format = 0;
  for (const OfferedMode& m : modes) {
    if (text.empty() || m.format != format) text += (text.empty() ? "" : ", ") + format_name(m.format);
    format = m.format;
    text += " " + std::to_string(m.width) + "x" + std::to_string(m.height);
  }
  return text;
}

}  // namespace cairn::camera
