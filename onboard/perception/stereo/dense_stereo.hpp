// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "hal/config/config.hpp"
#include "onboard/perception/stereo/disparity_field.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"

namespace cairn::stereo {

struct DisparityStart;

/// Settings of DenseStereo.
struct DenseStereoConfig {
  int disparities = 96;         ///< pixels that are searched; a multiple of 16
  int block_px = 5;             ///< edge of the blocks that are compared; odd
  int uniqueness_percent = 10;  ///< the best match must be so much better than the second
  int speckle_px = 150;         ///< smaller islands of equal depth are left out
  int stride_px = 3;            ///< every so many pixels of a row and of a column become a point
  double max_jump_px = 1.5;     ///< a point is left out where the disparity differs more within two pixels: an edge
  double plane_gate_px = 0.5;   ///< a point's neighbours on its plane are not farther from it; see DisparityField
  int plane_points = 12;        ///< a point is left out where fewer of the 81 around it are on its plane
};

/// Names, units and bounds of every key (config section `stereo.dense`).
void declare(config::Section& section, DenseStereoConfig& config);

/// The points that both eyes see: semi-global matching (Hirschmüller, 2008) by OpenCV, then DisparityRefiner, and then
/// DisparityField. The result does not depend on the number of threads.
class DenseStereo {
 public:
  DenseStereo(const DenseStereoConfig& config, const StereoGeometry& geometry);
  DenseStereo(DenseStereo&&) noexcept;
  DenseStereo& operator=(DenseStereo&&) noexcept;
  DenseStereo(const DenseStereo&) = delete;
  DenseStereo& operator=(const DenseStereo&) = delete;
  ~DenseStereo();

  /// Fills `points` in the optical frame, metres, row by row. None is farther than `max_range_m` along the view.
  void measure(const StereoPair& pair, double max_range_m, std::vector<Eigen::Vector3f>& points);

 private:
  struct Matcher;
  [[nodiscard]] std::optional<DisparityStart> start_at(int x, int y) const;
  [[nodiscard]] int pixel(int sample) const { return kFirst_px + config_.stride_px * sample; }
  void search(const StereoPair& pair);
  void refine(const StereoPair& pair, double least_px);

  static constexpr int kFirst_px = 2;  // column and row of the first sample
  DenseStereoConfig config_;
  StereoGeometry geometry_;
  std::unique_ptr<Matcher> matcher_;
  DisparityField field_;  // of the last pair; reused
};

}  // namespace cairn::stereo
