// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/people_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <utility>

namespace cairn::app {

void PeopleLog::add(std::span<const people::Person> people, const Eigen::Vector2d& robot) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const people::Person& p : people) nearest = std::min(nearest, static_cast<float>((p.position - robot).norm()));
  nearest_now_.store(nearest, std::memory_order_relaxed);
  now_.store(static_cast<std::uint32_t>(people.size()), std::memory_order_relaxed);
  nearest_ = std::min(nearest_, nearest);
  most_at_once_ = std::max(most_at_once_, people.size());
  for (const people::Person& p : people) {
    tracks_.store(std::max(tracks(), p.id), std::memory_order_relaxed);
    if (full()) return;
    rows_.push_back({p.stamp, p.id, p.sightings, static_cast<float>(p.position.x()), static_cast<float>(p.position.y()),
                     static_cast<float>(p.velocity.x()), static_cast<float>(p.velocity.y()),
                     static_cast<float>(std::sqrt(0.5 * p.covariance.trace())), p.ground});
  }
}

std::vector<std::vector<Eigen::Vector2d>> PeopleLog::paths(std::size_t most) const {
  std::map<std::uint32_t, std::vector<Eigen::Vector2d>> by_id;
  for (const Row& r : rows_) by_id[r.id].emplace_back(static_cast<double>(r.x), static_cast<double>(r.y));
  std::vector<std::size_t> lengths;
  for (const auto& [id, path] : by_id) lengths.push_back(path.size());
  std::ranges::sort(lengths, std::greater());
  const std::size_t least = lengths.size() > most ? lengths[most] : 0;
  std::vector<std::vector<Eigen::Vector2d>> kept;
  for (auto& [id, path] : by_id)
    if (path.size() > least) kept.push_back(std::move(path));
  return kept;
}

std::string PeopleLog::to_csv(Duration shift) const {
  std::string text = "t,id,x,y,vx,vy,sigma_m,sightings,z\n";
  char line[160];
  for (const Row& r : rows_) {
    const auto value = [](float v) { return static_cast<double>(v); };
    const int length = std::snprintf(line, sizeof line, "%.6f,%u,%.3f,%.3f,%.3f,%.3f,%.3f,%u,%.2f\n",
                                     to_seconds(r.stamp - shift - Time{}), r.id, value(r.x), value(r.y), value(r.vx),
                                     value(r.vy), value(r.sigma), r.sightings, value(r.z));
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace cairn::app
