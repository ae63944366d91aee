// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/field_reader.hpp"

#include <algorithm>

namespace cairn::clients {
namespace {

// m. No robot's map is larger.
constexpr double kMostMetres = 1e7;
constexpr double kUnit = 1e-6;  // a quaternion's length may be off by so much

bool continues_a_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

std::string FieldReader::text(std::size_t most) {
  const auto size = up_to(static_cast<std::uint8_t>(std::min<std::size_t>(most, 0xFF)));
  const auto part = bytes(size);
  return {reinterpret_cast<const char*>(part.data()), part.size()};
}

SE3 FieldReader::pose() {
  Eigen::Vector3d xyz;
  for (double& value : xyz) value = real(kMostMetres);
  Eigen::Quaterniond q;
  for (double& value : q.coeffs()) value = real(2);
  require(std::abs(q.norm() - 1) <= kUnit);
  return good_ ? SE3(q, xyz) : SE3();
}

void append_text(std::vector<std::byte>& out, std::string_view text, std::size_t most) {
  std::size_t size = std::min({text.size(), most, std::size_t{0xFF}});
  while (size > 0 && size < text.size() && continues_a_character(text[size])) --size;
  append_le(out, static_cast<std::uint8_t>(size));
  const auto bytes = std::as_bytes(std::span(text.substr(0, size)));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_pose(std::vector<std::byte>& out, const SE3& pose) {
  for (const double value : pose.translation()) append_le(out, value);
  for (const double value : pose.quaternion().coeffs()) append_le(out, value);
}

}  // namespace cairn::clients
