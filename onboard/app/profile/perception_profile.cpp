// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/perception_profile.hpp"

namespace cairn::app {

void declare(config::Section& s, PerceptionProfile& p) {
  declare(s, p.networks);
  s.group("labelling", p.labelling, "how points of scans get the labels of pictures");
  s.group("people", p.people, "how people are found, followed and kept out of the map");
  s.group("mount", p.mount, "how it is noticed that a camera was moved");
}

Result<void> check(const PerceptionProfile& profile) { return check(profile.networks); }

}  // namespace cairn::app
