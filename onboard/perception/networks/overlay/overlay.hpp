// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/image.hpp"
#include "hal/labels.hpp"
#include "hal/result.hpp"

// What networks said, painted over the picture for people to look at.
namespace cairn::networks {

/// A picture that can be painted on: `picture` (kBgr8 or kMono8) in colour. A small one is enlarged by a whole number,
/// as long as it stays narrower than `wide` pixels: names of boxes need room. Error kUnsupported: another format, or an
/// empty picture.
[[nodiscard]] Result<void> to_colour(const Image& picture, int wide, Image& colour);

/// Mixes the colour of each pixel's class into a kBgr8 picture of any size. `opacity`: 0…1. Pixels without a class keep
/// their colour.
void paint_labels(const LabelImage& labels, double opacity, Image& colour);

/// Draws boxes with class and score in percent into a kBgr8 picture, which may be enlarged.
void paint_boxes(const Detections& detections, Image& colour);

/// Adds a band below a kBgr8 picture that names the colours of all classes with at least one pixel in a hundred.
void add_legend(const LabelImage& labels, Image& colour);

/// A kBgr8 picture as PNG. Error kIo.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const Image& colour);

}  // namespace cairn::networks
