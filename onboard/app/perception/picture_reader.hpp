// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "drivers/camera/camera.hpp"
#include "drivers/thermal/thermal.hpp"
#include "hal/image.hpp"
#include "hal/packet.hpp"
#include "hal/result.hpp"
#include "onboard/safety/stuck.hpp"

namespace cairn::app {

/// From a camera's packet to the picture that a network looks at.
class PictureReader {
 public:
  PictureReader() = default;
  PictureReader(const PictureReader&) = delete;
  PictureReader& operator=(const PictureReader&) = delete;
  virtual ~PictureReader() = default;

  /// Null: there is nothing to look at, and no fault. The picture is valid until the next call. An Error says why
  /// nothing can be seen on it.
  virtual Result<const Image*> read(const Packet& packet) = 0;
};

/// How the pictures of a camera must be.
struct PictureForm {
  int width = 0, height = 0;  ///< pixels of the picture that is looked at, as the calibration says
  bool side_by_side = false;  ///< the left half is looked at
  bool judged = true;         ///< pictures on which nothing can be seen are refused; recorded answers need no judgement
};

/// Colour pictures. Those on which nothing can be seen, and repeated ones, are refused.
class ColourReader final : public PictureReader {
 public:
  ColourReader(camera::Camera camera, const PictureForm& form) : camera_(std::move(camera)), form_(form) {}
  /// Errors: those of the decoder; kMalformed for another size, a picture that came before, one that is too dark or too
  /// bright.
  Result<const Image*> read(const Packet& packet) override;

 private:
  Result<const Image*> decode(const Packet& packet);

  camera::Camera camera_;
  PictureForm form_;
  safety::StuckWatch stuck_;
  Image left_;
};

/// Thermal pictures, spread over 8 bits. While the camera corrects its flat field there is nothing to look at.
/// Overexposed and repeated ones are refused.
class ThermalReader final : public PictureReader {
 public:
  ThermalReader(thermal::Thermal camera, const PictureForm& form) : camera_(std::move(camera)), form_(form) {}
  Result<const Image*> read(const Packet& packet) override;

 private:
  thermal::Thermal camera_;
  PictureForm form_;
  safety::StuckWatch stuck_;
};

}  // namespace cairn::app
