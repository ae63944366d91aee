// SPDX-License-Identifier: Apache-2.0
// Any text is either a calibration whose cameras can be used, or a list of faults.
#include <cmath>
#include <string_view>

#include "onboard/perception/cameras/calibration_file.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace cairn;
using namespace cairn::cameras;

/// What the model sees, it sees in its picture, and knows where it looked.
void use(CameraParameters p) {
  if (p.width == 0) p.width = 640;
  if (p.height == 0) p.height = 480;
  const auto model = CameraModel::create(p);
  require(model.has_value());
  for (double x = -4; x <= 4; x += 0.5)
    for (double y = -4; y <= 4; y += 0.5)
      if (const auto pixel = model->project({x, y, 1})) {
        require(model->in_picture(*pixel));
        if (const auto ray = model->unproject(*pixel)) require(std::abs(ray->norm() - 1) < 1e-9);
      }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto calibration = parse_calibration({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!calibration) return 0;
  require(!calibration->cameras.empty() && calibration->cameras.size() <= Calibration::kMaxCameras);
  for (const CalibratedCamera& camera : calibration->cameras) {
    use(camera.parameters);
    if (camera.T_body_optical) require(std::isfinite(camera.T_body_optical->translation().norm()));
  }
  return 0;
}
