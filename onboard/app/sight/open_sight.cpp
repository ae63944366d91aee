// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_sight.hpp"

#include <utility>

namespace cairn::app {

Result<Sight> open_sight(const RunOptions& options, const RobotProfile& profile,
                         const std::filesystem::path& profile_file, std::span<const recording::SourceEntry> sources,
                         Monitor& monitor) {
  auto eyes = open_stereo(profile, sources);
  if (!eyes) return eyes.error();
  auto labels = open_perception(options, profile, profile_file, sources, monitor);
  if (!labels) return labels.error();
  PeopleWatch people;
  if (!*eyes || profile.perception.people.follow == "always") {
    auto watch = open_people(options, profile, profile_file, sources, monitor);
    if (!watch) return watch.error();
    people = std::move(*watch);
  }
  return Sight{std::move(*labels), std::move(people), open_mounts(options, profile, sources, monitor),
               std::move(*eyes)};
}

}  // namespace cairn::app
