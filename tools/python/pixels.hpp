// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/image.hpp"
#include "tools/python/arrays.hpp"

namespace cairn::python {

/// A copy as a numpy array of shape (height, width) or (height, width, channels).
[[nodiscard]] py::array to_pixels(const ImageView& view);

}  // namespace cairn::python
