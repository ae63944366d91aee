// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "hal/time.hpp"

namespace cairn::people {

/// A box beside somebody who is followed.
struct BoxBeside {
  std::uint32_t person = 0;  ///< see Person::id
  double angle = 0;          ///< from the person to the box, rad, positive to the right
};

/// How far a camera's boxes are beside the people that they show. If those of several people are shifted alike, the
/// camera was knocked. One person tells little: who walks is not where the scan saw him when the picture was taken.
class EyeOffset {
 public:
  static constexpr double kMoved = 0.026;       ///< rad, 1.5°: a camera whose boxes are farther aside was moved
  static constexpr std::size_t kSamples = 256;  ///< kept, the newest
  static constexpr int kLeastEach = 3;          ///< boxes of a person that say something
  static constexpr std::size_t kLeastPeople = 4;
  static constexpr Duration kMemory = std::chrono::seconds(60);

  /// Of a picture at `stamp`.
  void add(Time stamp, std::span<const BoxBeside> boxes);
  void clear();

  /// The middle one of people's middle ones, rad; none: too few people were seen in the last minute.
  [[nodiscard]] std::optional<double> angle() const { return angle_; }
  /// The boxes are aside, and those of most people to the same side.
  [[nodiscard]] bool moved() const { return moved_; }

 private:
  struct Sample {
    Time stamp{};
    BoxBeside box;
  };
  [[nodiscard]] std::vector<double> angle_of_each() const;
  void judge();

  std::deque<Sample> samples_;
  std::optional<double> angle_;
  bool moved_ = false;
};

}  // namespace cairn::people
