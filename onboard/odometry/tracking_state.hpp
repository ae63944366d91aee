// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"
#include "onboard/odometry/registration.hpp"

namespace cairn::odometry {

/// What becomes of a scan after its registration.
enum class Track : std::uint8_t {
  kFollowed,       ///< the fit is plausible: it corrects the prediction
  kLost,           ///< it is not: the prediction stands, the map is left alone
  kReinitialised,  ///< lost for too long: a new map begins at the prediction
};
[[nodiscard]] std::string_view to_string(Track track);

/// What is known of the scans so far: when the last one was, how long a whole one takes, how many
/// in a row were lost.
class TrackingState {
 public:
  explicit TrackingState(const OdometryConfig& config);

  /// A trajectory begins, or goes on from a previous run: with a pose at `stamp`.
  void begin(Time stamp);
  [[nodiscard]] bool began() const { return last_stamp_.has_value(); }
  /// After begin(). Not later than the last scan's stamp: ≤ 0.
  [[nodiscard]] double seconds_since_last(Time stamp) const { return to_seconds(stamp - *last_stamp_); }

  /// The same since the last scan that was followed or began a map.
  [[nodiscard]] double seconds_since_followed(Time stamp) const { return to_seconds(stamp - followed_stamp_); }
  /// The last scan was lost.
  [[nodiscard]] bool lost() const { return lost_in_a_row_ > 0; }

  /// The scan follows a gap and shows less than 0.6 of a revolution: too little to find the way
  /// back with.
  [[nodiscard]] bool is_fragment_after_gap(double dt_s, double duration_s) const;
  /// The scan shows less than 0.6 of a revolution.
  [[nodiscard]] bool is_fragment(double duration_s) const;
  /// The last scan took `whole_s`, and less than 0.9 of it has come since, no three times as long ago.
  [[nodiscard]] bool is_piece_after(double whole_s, Time stamp, double duration_s) const;
  /// So was the last one that was used.
  [[nodiscard]] bool last_was_fragment() const { return last_was_fragment_; }
  /// Takes note of a scan that is used.
  void advance(Time stamp, double duration_s);
  /// No scan came for longer than SecondLookConfig::blind_after_s, and none was followed since.
  [[nodiscard]] bool blind() const { return blind_; }

  /// Judges a fit that says the base made this `motion` in `dt_s` seconds. Counts the lost scans in
  /// a row. Not `sure`: it may be of another place. `patience`: so many lost scans in a row begin a new map.
  [[nodiscard]] Track judge(const Fit& fit, const SE3& motion, double dt_s, const PatchMap& map, bool sure,
                            int patience);

  /// Enough keypoints match, and enough of them fit. For fewer directions fewer matches are enough.
  [[nodiscard]] bool fits(const Fit& fit) const;

 private:
  [[nodiscard]] bool plausible(const Fit& fit, const SE3& motion, double dt_s) const;

  double blind_after_s_;
  int min_matches_;
  double min_inlier_ratio_, max_speed_m_s_, max_angular_speed_rad_s_;

  std::optional<Time> last_stamp_;
  Time followed_stamp_{};
  double revolution_s_ = 0;  // the longest of the last scans; 0 while scans have no firing times
  bool last_was_fragment_ = false;
  bool blind_ = false;
  int lost_in_a_row_ = 0;
};

}  // namespace cairn::odometry
