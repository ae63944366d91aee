// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/people_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cairn::app {

void PeopleLog::add(std::span<const people::Person> people) {
  for (const people::Person& p : people) {
    tracks_ = std::max(tracks_, p.id);
    if (full()) return;
    rows_.push_back({p.stamp, p.id, p.sightings, static_cast<float>(p.position.x()), static_cast<float>(p.position.y()),
                     static_cast<float>(p.velocity.x()), static_cast<float>(p.velocity.y()),
                     static_cast<float>(std::sqrt(0.5 * p.covariance.trace()))});
  }
}

std::string PeopleLog::to_csv(Duration shift) const {
  std::string text = "t,id,x,y,vx,vy,sigma_m,sightings\n";
  char line[160];
  for (const Row& r : rows_) {
    const auto value = [](float v) { return static_cast<double>(v); };
    const int length =
        std::snprintf(line, sizeof line, "%.6f,%u,%.3f,%.3f,%.3f,%.3f,%.3f,%u\n", to_seconds(r.stamp - shift - Time{}),
                      r.id, value(r.x), value(r.y), value(r.vx), value(r.vy), value(r.sigma), r.sightings);
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace cairn::app
