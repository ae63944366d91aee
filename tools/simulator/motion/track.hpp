// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::simulator {

/// Where base_link truly is, at any time of a run.
class Track {
 public:
  virtual ~Track() = default;
  [[nodiscard]] virtual Time start() const = 0;
  [[nodiscard]] virtual SE3 T_world_base(Time t) const = 0;

 protected:
  Track() = default;
  Track(const Track&) = default;
  Track& operator=(const Track&) = default;
};

}  // namespace cairn::simulator
