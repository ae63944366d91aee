// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"

namespace cairn::visual_odometry {

/// Corners and how they are followed.
struct TrackingConfig {
  int features = 260;       ///< corners that are followed at most
  int spacing_px = 18;      ///< pixels between corners, at least
  double quality = 0.0015;  ///< of a corner: smallest eigenvalue of its gradients, as a share of the strongest one's
  int window_px = 15;       ///< edge of the patch that is compared, pixels
  int levels = 3;           ///< of the pyramid above the picture itself
  double max_row_error_px = 1.0;  ///< the same corner may lie so far from its row in the right eye, pixels
};

/// Local bundle adjustment. See BundleAdjuster.
struct AdjustmentConfig {
  int keyframes = 8;              ///< the last ones, which are adjusted together
  int fixed = 3;                  ///< of these, the oldest keep their poses; the newest never does
  int max_steps = 3;              ///< per keyframe; the budget may grant fewer
  double pixel_noise = 0.1;       ///< pixels, 1 σ of a corner whose patch was found
  double disparity_noise = 0.07;  ///< pixels, 1 σ of its difference between both eyes
};

/// Settings of StereoOdometry.
struct VisualOdometryConfig {
  TrackingConfig tracking;
  AdjustmentConfig adjustment;

  // Weights
  double pixel_noise = 0.35;      ///< pixels, 1 σ of a followed corner
  double disparity_noise = 0.35;  ///< pixels, 1 σ of the difference between both eyes
  double correlation_factor = 4;  ///< corners per independent piece of information
  /// The same for the landmarks that one keyframe adds: they err in common.
  double landmark_correlation = 5;
  int max_iterations = 8;  ///< steps per frame; the budget may grant fewer

  // Keyframes and landmarks
  double keyframe_share = 0.7;  ///< of the landmarks of the last keyframe; with fewer in view a new one begins
  double keyframe_m = 0.3;      ///< m. A longer way from the last keyframe begins a new one.
  double keyframe_rad = 0.2;    ///< rad. A larger turn begins a new one.
  double max_depth_m = 40;      ///< m. Farther landmarks tell the turn alone; they are used with their uncertainty.

  // Motion: standard deviations of a white acceleration, and of the first speed
  double linear_acceleration = 3.0;    ///< m/s²
  double angular_acceleration = 6.0;   ///< rad/s²
  double initial_speed = 3.0;          ///< m/s
  double initial_angular_speed = 1.0;  ///< rad/s

  // When a frame is lost
  int min_inliers = 10;            ///< landmarks that must fit
  double min_inlier_share = 0.35;  ///< of the landmarks that were followed
  double give_up_after_s = 1.5;    ///< s. Lost for longer, a new map begins.
};

/// Names, units and bounds of every key (config section `visual_odometry`).
void declare(config::Section& section, VisualOdometryConfig& c);
void declare(config::Section& section, TrackingConfig& c);
void declare(config::Section& section, AdjustmentConfig& c);

}  // namespace cairn::visual_odometry
