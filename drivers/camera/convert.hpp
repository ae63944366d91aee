// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/camera/frame.hpp"
#include "hal/image.hpp"

namespace cairn::camera {

/// Fills format, size and bytes of `image`, reusing its memory: colour formats become kBgr8, GREY kMono8, Y16 kMono16,
/// Z16 kDepth16. YUV is BT.601 limited range, as UVC cameras send it. A JPEG has to have the frame's size; its
/// dimensions are checked before it is decoded. Errors: kMalformed, kTruncated, kUnsupported, with OpenCV's own words
/// in `detail`; `image` is then of no use.
[[nodiscard]] Result<void> to_image(const Frame& frame, Image& image);

}  // namespace cairn::camera
