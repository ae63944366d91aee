// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace cairn::simulator {

/// The area of the part of a triangle that lies inside of a cube around `centre` with edges of 2 × `half`, in the
/// square of their unit. The triangle is clipped at the six faces, one after the other (Sutherland and Hodgman, 1974).
[[nodiscard]] double clipped_area(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& centre,
                                  double half);

}  // namespace cairn::simulator
