// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "onboard/perception/people/track.hpp"

namespace cairn::app {

/// Where people were during a run, for people.csv: t,id,x,y,vx,vy,sigma_m,sightings in seconds, metres and m/s of odom.
/// A row for each person and scan, in the order of time.
class PeopleLog {
 public:
  static constexpr std::size_t kMostRows = std::size_t{1} << 22U;  ///< 11 hours with ten people; then no more are kept

  void add(std::span<const people::Person> people);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  /// Different people.
  [[nodiscard]] std::uint32_t tracks() const { return tracks_; }
  [[nodiscard]] bool full() const { return rows_.size() == kMostRows; }
  /// `shift`: what was added to the recording's time.
  [[nodiscard]] std::string to_csv(Duration shift) const;

 private:
  struct Row {
    Time stamp;
    std::uint32_t id, sightings;
    float x, y, vx, vy, sigma;
  };
  std::vector<Row> rows_;
  std::uint32_t tracks_ = 0;
};

}  // namespace cairn::app
