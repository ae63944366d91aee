// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <deque>

#include "hal/time.hpp"
#include "onboard/perception/people/cluster_finder.hpp"

namespace cairn::people {

/// Somebody who is followed.
struct Person {
  std::uint32_t id = 0;  ///< counts from 1, in the order in which people were found; never used again
  Time stamp{};          ///< of the scan that all of this is of
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        ///< of the body's middle, odom, m
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();        ///< odom, m/s
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of the position, m²
  float ground = 0;                                          ///< z of the ground below, odom, m
  std::uint32_t sightings = 0;                               ///< pictures in which a detector saw this person
  bool seen = false;                                         ///< in this scan; otherwise the place is predicted
};

/// Where a track was.
struct Step {
  Time stamp{};
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< odom, m
  std::int32_t body = -1;                              ///< number in Tracker::bodies() of that scan; -1: predicted
  float ground = 0;                                    ///< z of the ground there, odom, m
};

/// Constant velocity in the plane, disturbed by white acceleration; a Kalman filter of x, y, vx, vy.
class Track {
 public:
  static constexpr Duration kMemory = std::chrono::milliseconds(2000);  ///< of steps
  static constexpr Duration kAWhile = std::chrono::milliseconds(700);

  /// Begins where a cluster was seen, at an unknown walking speed.
  Track(Time stamp, const Eigen::Vector2d& position, float ground, std::int32_t body);

  /// To a later scan. The track counts as not seen in it until update().
  void predict(Time stamp);
  /// A measured position, m; `sigma_m` on each axis. `body`: its number in Tracker::bodies().
  void update(const Eigen::Vector2d& position, double sigma_m, std::int32_t body);
  /// It was lost, and is here: its velocity is not known any more.
  void restart(const Eigen::Vector2d& position, std::int32_t body);
  /// Squared Mahalanobis distance of a position that is measured with `sigma_m`.
  [[nodiscard]] double distance2(const Eigen::Vector2d& position, double sigma_m) const;

  /// Adds nats for or against this being a person. It is bounded: nobody is surer than a few pictures can undo.
  void weigh(double nats);
  /// Who stands still where no camera looks is ever less sure to be a person: slowly where the place was free before,
  /// soon where it was not. `body`: what is seen of it.
  void doubt(Time stamp, const Cluster& body);
  [[nodiscard]] double evidence() const { return evidence_; }

  /// It has walked within the last second or two: far enough, on a line, and seen all along.
  [[nodiscard]] bool walked() const;
  [[nodiscard]] bool walked(double length_m, double time_s) const;
  /// That it walked counts once.
  void walks();
  [[nodiscard]] bool known_walker() const { return known_walker_; }
  /// A scan looks through the place where it is expected.
  void miss() { ++misses_; }
  [[nodiscard]] int misses() const { return misses_; }
  /// Its points are in places that were free. True once: when that was so in enough scans.
  bool enters() { return ++entered_ == kEnters; }
  /// It is as high and as wide as a person, in places of which nothing was known. True once: when that was so in enough
  /// scans.
  bool stands_upright() { return ++upright_ == kUpright; }
  [[nodiscard]] bool upright() const { return upright_ >= kUpright; }
  [[nodiscard]] bool newcomer() const { return entered_ >= kEnters; }
  [[nodiscard]] Duration age() const { return person_.stamp - began_; }

  [[nodiscard]] const std::deque<Step>& steps() const { return steps_; }
  [[nodiscard]] Time last_seen() const { return last_seen_; }
  /// When it last stood alone, or a detector saw it.
  [[nodiscard]] Time last_sure() const { return last_sure_; }
  void sure(Time stamp) { last_sure_ = std::max(last_sure_, stamp); }
  /// It is a person, or has been seen for a while.
  [[nodiscard]] bool known() const { return confirmed || last_seen_ - began_ > kAWhile; }
  [[nodiscard]] const Person& person() const { return person_; }
  /// A detector saw it in a picture of that time.
  void sighted(Time stamp) {
    ++person_.sightings;
    sure(stamp);
    last_sighted_ = std::max(last_sighted_, stamp);
  }
  /// What the ground is like where it was measured.
  void stand_on(float ground) { person_.ground = steps_.back().ground = ground; }
  void name(std::uint32_t id) { person_.id = id; }

  bool confirmed = false;  ///< it is a person
  bool ended = false;      ///< it is to go
  bool hidden = false;     ///< nobody knows where it is now; somebody who appears around there may be it
  bool reported = false;   ///< its beginning has been handed on

 private:
  void publish();

  Eigen::Vector4d state_;
  Eigen::Matrix4d covariance_;
  Person person_;
  Time began_, last_seen_, last_sure_, last_sighted_{};
  static constexpr int kEnters = 2, kUpright = 2;  // scans
  double evidence_;
  bool known_walker_ = false;
  int misses_ = 0;
  int entered_ = 0;  // scans in which its points were in free places
  int upright_ = 0;  // scans in which it was as high and as wide as a person
  std::deque<Step> steps_;
};

}  // namespace cairn::people
