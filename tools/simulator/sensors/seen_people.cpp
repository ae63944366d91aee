// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/seen_people.hpp"

#include <algorithm>

namespace cairn::simulator {

void SeenPeople::begin(std::size_t people, int height) {
  people_ = people;
  parts_.assign(people * static_cast<std::size_t>(height), Part{});
}

void SeenPeople::add_row(int row, const Eigen::Vector3d& eye, std::span<const Sighting> seen,
                         std::span<const Figure> figures) {
  const std::span<Part> parts = std::span(parts_).subspan(static_cast<std::size_t>(row) * people_, people_);
  for (int u = 0; u < static_cast<int>(seen.size()); ++u) {
    const Sighting& s = seen[static_cast<std::size_t>(u)];
    for (const Figure& figure : figures)
      if (trace(std::span(&figure, 1), {eye, s.direction}, kSight))
        ++parts[static_cast<std::size_t>(figure.person)].alone;
    if (s.person < 0) continue;
    Part& part = parts[static_cast<std::size_t>(s.person)];
    if (part.seen++ == 0) part.left = u;
    part.right = u;
  }
}

/// Its score is 0 if too little is seen.
Detection SeenPeople::box(std::size_t person, const LeastSeen& least) const {
  Part all;
  int top = -1, bottom = -1;
  for (std::size_t row = 0; row * people_ < parts_.size(); ++row) {
    const Part& part = parts_[row * people_ + person];
    all.alone += part.alone;
    if (part.seen == 0) continue;
    all.left = all.seen == 0 ? part.left : std::min(all.left, part.left);
    all.right = std::max(all.right, part.right);
    all.seen += part.seen;
    bottom = static_cast<int>(row);
    if (top < 0) top = bottom;
  }
  // The same ray may graze a person here and miss them there by the last bit.
  const double share = std::min(1.0, static_cast<double>(all.seen) / std::max(all.alone, 1));
  if (all.seen == 0 || all.seen < least.pixels || share < least.share) return {};
  return {static_cast<float>(all.left),
          static_cast<float>(top),
          static_cast<float>(all.right + 1 - all.left),
          static_cast<float>(bottom + 1 - top),
          kPersonClass,
          static_cast<float>(share)};
}

std::vector<Detection> SeenPeople::boxes(const LeastSeen& least) const {
  std::vector<Detection> found;
  for (std::size_t person = 0; person < people_; ++person)
    if (const Detection seen = box(person, least); seen.score > 0) found.push_back(seen);
  return found;
}

}  // namespace cairn::simulator
