// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/clouds/scan.hpp"

#include "drivers/clients/messages/clouds/cloud_part.hpp"

namespace cairn::clients {

std::uint32_t encode(const ScanPart& part, std::span<const Eigen::Vector3f> points, std::vector<std::byte>& out) {
  return append_cloud(part, part.lost, points, out);
}

Result<ScanPart> decode_scan(std::span<const std::byte> body) {
  FieldReader in(body);
  ScanPart part;
  read_cloud(in, part, part.lost, part.points_base);
  if (!in.complete()) return in.error("not a part of a scan");
  return part;
}

}  // namespace cairn::clients
