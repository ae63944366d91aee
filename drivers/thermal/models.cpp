// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/models.hpp"

#include <algorithm>
#include <array>

namespace cairn::thermal {
namespace {

constexpr std::array kModels{
    Model{.name = "plain"},
    Model{.name = "lepton2", .width = 80, .height = 60, .rows = 3, .lepton_telemetry = true},
    Model{.name = "lepton3", .width = 160, .height = 120, .rows = 2, .lepton_telemetry = true},
    Model{.name = "boson320", .width = 320, .height = 256, .rows = 2},
    Model{.name = "boson640", .width = 640, .height = 512, .rows = 2},
    Model{.name = "optris_pi400", .width = 382, .height = 288, .rows = 2},
    Model{.name = "optris_pi450", .width = 382, .height = 288, .rows = 2},
};

}  // namespace

std::span<const Model> models() { return kModels; }

const Model* find_model(std::string_view name) {
  const auto* found = std::find_if(kModels.begin(), kModels.end(), [&](const Model& m) { return m.name == name; });
  return found == kModels.end() ? nullptr : found;
}

}  // namespace cairn::thermal
