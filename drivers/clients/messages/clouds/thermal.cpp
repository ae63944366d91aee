// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/clouds/thermal.hpp"

#include "drivers/clients/messages/clouds/cloud_part.hpp"

namespace cairn::clients {

static_assert(sizeof(ThermalPoint) == 4 * sizeof(float));

std::uint32_t encode(const ThermalPart& part, std::span<const ThermalPoint> points, std::vector<std::byte>& out) {
  return append_cloud(part, part.celsius, points, out);
}

Result<ThermalPart> decode_thermal(std::span<const std::byte> body) {
  FieldReader in(body);
  ThermalPart part;
  read_cloud(in, part, part.celsius, part.points);
  if (!in.complete()) return in.error("not a part of a thermal cloud");
  return part;
}

}  // namespace cairn::clients
