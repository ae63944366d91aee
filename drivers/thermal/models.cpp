// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/models.hpp"

#include <algorithm>
#include <array>

namespace cairn::thermal {
namespace {

constexpr std::array kModels{Model{"plain", 0, 0, 0, false},           Model{"lepton2", 80, 60, 3, true},
                             Model{"lepton3", 160, 120, 2, true},      Model{"boson320", 320, 256, 2, false},
                             Model{"boson640", 640, 512, 2, false},    Model{"optris_pi400", 382, 288, 2, false},
                             Model{"optris_pi450", 382, 288, 2, false}};

}  // namespace

std::span<const Model> models() { return kModels; }

const Model* find_model(std::string_view name) {
  const auto* found = std::find_if(kModels.begin(), kModels.end(), [&](const Model& m) { return m.name == name; });
  return found == kModels.end() ? nullptr : found;
}

}  // namespace cairn::thermal
