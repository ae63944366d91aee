// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/labels.hpp"
#include "hal/time.hpp"
#include "onboard/perception/networks/model/network.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// What one network did with the pictures of a recording.
class NetworkFigures {
 public:
  networks::NetworkFacts facts;
  std::uint64_t failed = 0;  ///< pictures that it gave no answer for

  void add_time(Duration wall, Duration cpu);
  void add(const LabelImage& labels);
  void add(const Detections& detections);

  [[nodiscard]] std::uint64_t pictures() const { return pictures_; }
  /// Model, times, and either the share of each class in the pixels or the number of boxes of each class.
  [[nodiscard]] report::Json to_json() const;
  /// The same as lines for people; `what`: the section of the profile.
  [[nodiscard]] std::string to_text(const std::string& what) const;

 private:
  static constexpr std::size_t kClasses = kSemanticClasses.size();
  std::uint64_t pictures_ = 0, pixels_ = 0, probability_sum_ = 0;
  bool labels_ = false;
  Duration wall_{}, longest_{}, cpu_{};
  std::array<std::uint64_t, kClasses + 1> of_class_{};  // pixels or boxes; the last: no class
};

}  // namespace cairn::cli
