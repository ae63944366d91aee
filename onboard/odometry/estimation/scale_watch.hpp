// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace cairn::odometry {

/// Whether a metre of the wheels is a metre of the way. It compares both over the last ten metres or so along which
/// scans told the motion. Errors of single steps cancel, and a wrong radius of the profile does not.
class ScaleWatch {
 public:
  static constexpr double kMostWrong = 0.15;  ///< share by which a metre of the wheels may be too long or too short

  /// A straight step, in metres: by the wheels, and by a scan that told everything.
  void add(double wheels_m, double base_m);

  /// Metres of the way for each metre of the wheels. None: too little way to say.
  [[nodiscard]] std::optional<double> scale() const;
  /// The wheels are wrong by more than kMostWrong: a wrong profile, or wheels that spin. Ends when they are within two
  /// thirds of it.
  [[nodiscard]] bool wrong() const { return wrong_; }

 private:
  double way_m_ = 0, wheels_m_ = 0, base_m_ = 0;  // sums; the past counts ever less
  bool wrong_ = false;
};

}  // namespace cairn::odometry
