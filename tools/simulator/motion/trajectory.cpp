// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/trajectory.hpp"

#include <algorithm>

namespace cairn::simulator {

Vector6 Trajectory::xyz_rpy(Time t) const {
  if (t <= start_) return knots_.front();
  if (t >= end()) return knots_.back();
  const std::int64_t since = (t - start_).count(), period = kKnotPeriod.count();
  const auto i = static_cast<std::size_t>(since / period);
  const double u = static_cast<double>(since % period) / static_cast<double>(period);
  const Vector6& before = knots_[i == 0 ? 0 : i - 1];
  const Vector6& from = knots_[i];
  const Vector6& to = knots_[i + 1];
  const Vector6& after = knots_[std::min(i + 2, knots_.size() - 1)];
  const double u2 = u * u, u3 = u2 * u;
  return 0.5 * ((2.0 * u2 - u3 - u) * before + (3.0 * u3 - 5.0 * u2 + 2.0) * from + (4.0 * u2 - 3.0 * u3 + u) * to +
                (u3 - u2) * after);
}

double Trajectory::length() const {
  double length = 0;
  for (std::size_t i = 1; i < knots_.size(); ++i) length += (knots_[i] - knots_[i - 1]).head<3>().norm();
  return length;
}

}  // namespace cairn::simulator
