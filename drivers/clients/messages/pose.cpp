// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/pose.hpp"

#include <algorithm>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr unsigned kPredicted = 1, kLost = 2, kFlags = kPredicted | kLost;
constexpr std::uint8_t kDirections = 6;

void append_covariance(std::vector<std::byte>& out, const Matrix6& m) {
  // A filter's rounding may leave a variance a little below zero, which no reader would take. What is no number stays.
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = i; j < 6; ++j) append_le(out, i == j ? std::max(m(i, j), 0.0) : m(i, j));
}

Matrix6 read_covariance(FieldReader& in) {
  Matrix6 m;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = i; j < 6; ++j) m(i, j) = m(j, i) = in.real(1e300);
  in.require((m.diagonal().array() >= 0).all());
  return m;
}

}  // namespace

void encode(const PoseMessage& message, std::vector<std::byte>& out) {
  append_time(out, message.stamp);
  append_le(out, static_cast<std::uint8_t>((message.predicted ? kPredicted : 0U) | (message.lost ? kLost : 0U)));
  append_le(out, message.degenerate_directions);
  append_le(out, std::uint16_t{0});
  append_le(out, message.epoch);
  append_pose(out, message.T_odom_base.mean);
  append_covariance(out, message.T_odom_base.covariance);
  for (const double value : message.twist) append_le(out, value);
}

Result<PoseMessage> decode_pose(std::span<const std::byte> body) {
  FieldReader in(body);
  PoseMessage message;
  message.stamp = in.time();
  const unsigned flags = in.up_to(static_cast<std::uint8_t>(kFlags));
  message.predicted = (flags & kPredicted) != 0;
  message.lost = (flags & kLost) != 0;
  message.degenerate_directions = in.up_to(kDirections);
  in.require(in.number<std::uint16_t>() == 0);
  message.epoch = in.number<std::uint32_t>();
  message.T_odom_base.mean = in.pose();
  message.T_odom_base.covariance = read_covariance(in);
  for (double& value : message.twist) value = in.real();
  if (!in.complete()) return in.error("not a pose");
  return message;
}

}  // namespace cairn::clients
