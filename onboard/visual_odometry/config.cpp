// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/config.hpp"

namespace cairn::visual_odometry {

void declare(config::Section& s, TrackingConfig& c) {
  s.integer("features", c.features, {50, 2000}, "", "corners that are followed at most");
  s.integer("spacing_px", c.spacing_px, {4, 100}, "pixels", "distance between corners, at least");
  s.number("quality", c.quality, {1e-5, 0.5}, "", "of a corner, as a share of the strongest one's");
  s.integer("window_px", c.window_px, {7, 41}, "pixels", "edge of the patch that is compared");
  s.integer("levels", c.levels, {0, 6}, "", "of the pyramid above the picture itself");
  s.number("max_row_error_px", c.max_row_error_px, {0.2, 5}, "pixels",
           "the same corner may lie so far from its row in the right eye");
}

void declare(config::Section& s, AdjustmentConfig& c) {
  s.integer("keyframes", c.keyframes, {2, 30}, "", "the last ones, which are adjusted together");
  s.integer("fixed", c.fixed, {1, 10}, "", "of these, the oldest keep their poses; the newest never does");
  s.integer("max_steps", c.max_steps, {0, 20}, "", "cap per keyframe; the budget may grant fewer");
  s.number("pixel_noise", c.pixel_noise, {0.01, 5}, "pixels", "1 sigma of a corner whose patch was found");
  s.number("disparity_noise", c.disparity_noise, {0.01, 5}, "pixels", "1 sigma of its difference between both eyes");
}

void declare(config::Section& s, VisualOdometryConfig& c) {
  s.group("tracking", c.tracking, "corners and how they are followed");
  s.group("adjustment", c.adjustment,
          "local bundle adjustment: the last keyframes and their landmarks, moved together");
  s.number("pixel_noise", c.pixel_noise, {0.05, 5}, "pixels", "1 sigma of a followed corner");
  s.number("disparity_noise", c.disparity_noise, {0.05, 5}, "pixels", "1 sigma of the difference between both eyes");
  s.number("correlation_factor", c.correlation_factor, {1, 100}, "", "corners per independent piece of information");
  s.number("landmark_correlation", c.landmark_correlation, {0, 1000}, "",
           "the same for the landmarks that one keyframe adds: they err in common");
  s.integer("max_iterations", c.max_iterations, {1, 50}, "", "cap per picture; the budget may grant fewer");
  s.number("keyframe_share", c.keyframe_share, {0.1, 1}, "",
           "with fewer landmarks of the last keyframe in view, a new one begins");
  s.number("keyframe_m", c.keyframe_m, {0.01, 10}, "m", "a longer way from the last keyframe begins a new one");
  s.number("keyframe_rad", c.keyframe_rad, {0.01, 1}, "rad", "a larger turn begins a new keyframe");
  s.number("max_depth_m", c.max_depth_m, {2, 200}, "m", "farther corners become no landmarks");
  s.number("linear_acceleration", c.linear_acceleration, {0.1, 50}, "m/s^2", "1 sigma of the motion model");
  s.number("angular_acceleration", c.angular_acceleration, {0.1, 100}, "rad/s^2", "1 sigma of the motion model");
  s.number("initial_speed", c.initial_speed, {0.01, 50}, "m/s", "1 sigma of the speed at the start");
  s.number("initial_angular_speed", c.initial_angular_speed, {0.01, 10}, "rad/s", "1 sigma of the turn at the start");
  s.integer("min_inliers", c.min_inliers, {6, 200}, "", "landmarks that must fit, or the picture is lost");
  s.number("min_inlier_share", c.min_inlier_share, {0.05, 0.95}, "", "of the landmarks that were followed");
  s.number("give_up_after_s", c.give_up_after_s, {0.2, 60}, "s", "lost for longer, a new map begins");
}

}  // namespace cairn::visual_odometry
