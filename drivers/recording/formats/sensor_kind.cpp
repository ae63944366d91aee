// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/sensor_kind.hpp"

namespace cairn::recording {

std::string list_of_sensor_kinds() {
  std::string list;
  for (const SensorKindRow& row : kSensorKinds) {
    if (&row != &kSensorKinds.front()) list += &row == &kSensorKinds.back() ? " or " : ", ";
    list += row.name;
  }
  return list;
}

}  // namespace cairn::recording
