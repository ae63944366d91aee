// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "onboard/odometry/coarse_search.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/keypoint_selector.hpp"
#include "onboard/odometry/registration.hpp"

namespace cairn::odometry {

/// Doubts a fit that is worse than usual, and looks for a better one farther around. A registration
/// that begins at a wrong prediction ends in a wrong place where some surfaces fit by chance. The
/// share of keypoints that fit falls then, long before it is so small that the scan counts as lost.
///
/// Only keypoints that tell are counted, see NormalEquations::telling. One thing floors and ceilings do
/// tell: if fewer of them fit than usual, the tilt or the height is wrong.
class SecondLook {
 public:
  SecondLook(const OdometryConfig& config, const SE3& T_base_lidar);

  /// The fit is worse than those of the last scans.
  [[nodiscard]] bool doubtful(const Fit& fit) const;
  /// The fit of a piece of a revolution is doubtful, or in a `settled` map less likely than 5 %, as was `predicted`. A
  /// piece sees few surfaces, and one that is mistaken for another moves it as a whole.
  [[nodiscard]] bool misled(const Fit& piece, const MotionFilter& predicted, bool settled) const;
  /// A fit so long after the last one that was followed may be of a place that looks alike: it is believed only if it
  /// is nearly as good as usual. `blind`: of a robot that nothing has told its way since, the motion that the fit
  /// means; null: something has. A blind robot is believed to have stood, or turned, and to be at rest.
  [[nodiscard]] bool sure(const Fit& fit, double dt_s, const SE3* blind) const;
  /// `first` fits worse than the last scans did, floors and ceilings included, or `dt_s` is so long
  /// that the prediction says little.
  [[nodiscard]] bool needed(const Fit& first, double dt_s) const;
  /// Whether the base can be there, as far as others know.
  using Possible = std::function<bool(const MotionState&)>;
  /// A fit that is clearly better than `first`, and possible, if there is one. Floors and ceilings count only if
  /// `first` fits them worse than usual, and the new fit clearly better. `wide` holds a prediction that
  /// expects anything; it is moved to where the better fit began. Leaves the uses of that fit, or of
  /// `first`, in `registration`.
  [[nodiscard]] std::optional<Fit> find(const Selection& scan, const PatchMap& map, MotionFilter& wide,
                                        const Fit& first, double dt_s, Registration& registration, Budget& budget,
                                        const Possible& possible);
  /// Takes note of what a fit that is followed looks like.
  void learn(const Fit& fit);
  /// So few points fit that the scan would blur the map.
  [[nodiscard]] bool blurred(const Fit& fit) const {
    return fit.telling_share() < config_.blurred_share * usual_share_;
  }
  /// A new map begins.
  void reset() {
    usual_share_ = 1;
    usual_level_ = 0;
    usual_spread_ = kFirstSpread;
  }

  static constexpr int kStepsOfATrial = 8;  ///< of its registration
  /// Of all trials of a find() together, at most.
  static constexpr int kTrialSteps = 2 * static_cast<int>(CoarseSearch::kPlaces) * kStepsOfATrial;

 private:
  static constexpr double kFirstSpread = 0.02;

  /// Fewer fit than the share's usual fluctuation explains.
  [[nodiscard]] bool unusual(const Fit& fit) const;
  [[nodiscard]] bool tilted(const Fit& fit) const;
  [[nodiscard]] bool better(const Fit& again, const Fit& first) const;
  void choose(const Selection& scan, const SE3& T_odom_base);

  [[nodiscard]] MotionState nodded(const Selection& scan, const MotionState& from, const PatchMap& map, double dt_s,
                                   Registration& registration);
  [[nodiscard]] MotionState refined(const MotionState& place, const PatchMap& map, double dt_s,
                                    Registration& registration);

  SecondLookConfig config_;
  double narrowest_gate_m_;
  SE3 T_base_lidar_;
  UprightPoints upright_;
  CoarseSearch search_;
  double usual_share_ = 1, usual_level_ = 0;
  double usual_spread_ = kFirstSpread;                  // mean difference of a share to the usual one
  double duration_s_ = 0;                               // of the scan
  std::vector<Keypoint> telling_, third_, few_, some_;  // of its keypoints
  struct Counted {
    MotionState state;
    int fits = 0;
  };
  std::vector<Counted> between_;
};

}  // namespace cairn::odometry
