// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"
#include "onboard/perception/labelling/labelling_config.hpp"
#include "onboard/perception/mount/mount_watch.hpp"
#include "onboard/perception/networks/config/network_config.hpp"
#include "onboard/perception/people/people_config.hpp"

namespace cairn::app {

/// What looks at the pictures, and how much the map believes it: section `perception`.
struct PerceptionProfile {
  networks::PerceptionConfig networks;
  labelling::LabellingConfig labelling;
  people::PeopleConfig people;
  mount::MountConfig mount;
};

void declare(config::Section& section, PerceptionProfile& profile);
/// What bounds cannot check. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const PerceptionProfile& profile);

}  // namespace cairn::app
