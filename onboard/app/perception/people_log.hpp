// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "onboard/perception/people/track.hpp"

namespace cairn::app {

/// Where people were during a run, for people.csv: t,id,x,y,vx,vy,sigma_m,sightings,z in seconds, metres and m/s of
/// odom; z is of the ground. A row for each person and scan, in the order of time.
class PeopleLog {
 public:
  static constexpr std::size_t kMostRows = std::size_t{1} << 22U;  ///< 11 hours with ten people; then no more are kept

  /// The people at a scan, and where the robot was; odom, m.
  void add(std::span<const people::Person> people, const Eigen::Vector2d& robot);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  /// Different people. Any thread.
  [[nodiscard]] std::uint32_t tracks() const { return tracks_.load(std::memory_order_relaxed); }
  /// How many there were at the last scan. Any thread.
  [[nodiscard]] std::uint32_t now() const { return now_.load(std::memory_order_relaxed); }
  /// How near the nearest of them was, m; infinite: there was nobody. Any thread.
  [[nodiscard]] float nearest_now() const { return nearest_now_.load(std::memory_order_relaxed); }
  /// How near anybody ever was, m; infinite: there was nobody.
  [[nodiscard]] float nearest() const { return nearest_; }
  /// The most at one scan.
  [[nodiscard]] std::size_t most_at_once() const { return most_at_once_; }
  [[nodiscard]] bool full() const { return rows_.size() == kMostRows; }
  /// `shift`: what was added to the recording's time.
  /// Where each of the people went, odom, m: those with the most rows, at most so many, in the order of their ids.
  [[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> paths(std::size_t most) const;
  [[nodiscard]] std::string to_csv(Duration shift) const;

 private:
  struct Row {
    Time stamp;
    std::uint32_t id, sightings;
    float x, y, vx, vy, sigma, z;
  };
  std::vector<Row> rows_;
  std::atomic<std::uint32_t> tracks_{0}, now_{0};
  std::atomic<float> nearest_now_{std::numeric_limits<float>::infinity()};
  float nearest_ = std::numeric_limits<float>::infinity();
  std::size_t most_at_once_ = 0;
};

}  // namespace cairn::app
