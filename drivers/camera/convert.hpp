// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/camera/frame.hpp"
#include "hal/image.hpp"

namespace cairn::camera {

/// Fills format, size and bytes of `image`, and reuses its memory. Colour formats become kBgr8, GREY kMono8, Y16
/// kMono16, Z16 kDepth16. YUV is BT.601 limited range, as UVC cameras send it. A JPEG must have the size of the frame,
/// which is checked before it is decoded. Errors: kMalformed, kTruncated, kUnsupported, with OpenCV's message in
/// `detail`. The content of `image` is then undefined.
[[nodiscard]] Result<void> to_image(const Frame& frame, Image& image);

}  // namespace cairn::camera
