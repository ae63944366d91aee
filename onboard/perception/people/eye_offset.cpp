// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/eye_offset.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cairn::people {
namespace {

double middle_of(std::vector<double>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace

void EyeOffset::add(Time stamp, std::span<const BoxBeside> boxes) {
  for (const BoxBeside& box : boxes) samples_.push_back({stamp, box});
  while (!samples_.empty() && (samples_.size() > kSamples || stamp - samples_.front().stamp > kMemory))
    samples_.pop_front();
  if (!boxes.empty()) judge();
}

void EyeOffset::clear() {
  samples_.clear();
  angle_.reset();
  moved_ = false;
}

std::vector<double> EyeOffset::angle_of_each() const {
  std::map<std::uint32_t, std::vector<double>> by_person;
  for (const Sample& s : samples_) by_person[s.box.person].push_back(s.box.angle);
  std::vector<double> angles;
  for (auto& [person, all] : by_person)
    if (static_cast<int>(all.size()) >= kLeastEach) angles.push_back(middle_of(all));
  return angles;
}

/// To be believed again, a camera has to come back half of the way.
void EyeOffset::judge() {
  std::vector<double> angles = angle_of_each();
  angle_.reset();
  if (angles.size() < kLeastPeople) return;
  const double middle = middle_of(angles);
  angle_ = middle;
  const auto on_its_side = std::ranges::count_if(angles, [=](double a) { return a * middle > 0; });
  const bool agree = 4 * on_its_side >= 3 * static_cast<std::ptrdiff_t>(angles.size());
  moved_ = std::abs(middle) > (moved_ ? kMoved / 2 : kMoved) && (moved_ || agree);
}

}  // namespace cairn::people
