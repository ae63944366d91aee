// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

/// How much can be seen of the surface at `p` with this normal (unit length, either side): the share of five directions
/// that meet nothing within 0.3 m and end where `known` says so, on the side where it is larger. 0: the surface is
/// covered, as concrete is by a coat of paint that the mesh has as a body of its own. `known` keeps out the inside of
/// walls and what is below the ground.
[[nodiscard]] double openness(const Tracer& tracer, const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                              const std::function<bool(const Eigen::Vector3d&)>& known);

}  // namespace cairn::simulator
