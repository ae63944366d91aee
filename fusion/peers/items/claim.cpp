// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/claim.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "hal/bytes.hpp"

namespace cairn::peers {
namespace {

constexpr double kFarthestM = 1e6, kUnitTolerance = 1e-6, kLargestVariance = 1e12;

void append_pose(std::vector<std::byte>& out, const UncertainPose& pose) {
  for (const double value : pose.mean.translation()) append_le(out, value);
  Eigen::Quaterniond q = pose.mean.quaternion();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  for (const double value : q.coeffs()) append_le(out, value);
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index k = i; k < 6; ++k) append_le(out, static_cast<float>(pose.covariance(i, k)));
}

std::optional<SE3> read_mean(ByteReader& in) {
  Eigen::Vector3d t;
  Eigen::Vector4d q;
  for (double& value : t) value = in.read<double>().value_or(NAN);
  for (double& value : q) value = in.read<double>().value_or(NAN);
  const bool sound = t.cwiseAbs().maxCoeff() <= kFarthestM && std::abs(q.norm() - 1) <= kUnitTolerance && q[3] >= 0;
  if (!sound || !t.allFinite() || !q.allFinite()) return std::nullopt;
  return SE3(Eigen::Quaterniond(q), t);
}

std::optional<Matrix6> read_covariance(ByteReader& in) {
  Matrix6 covariance;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index k = i; k < 6; ++k)
      covariance(i, k) = covariance(k, i) = static_cast<double>(in.read<float>().value_or(NAN));
  const bool sound = covariance.allFinite() && covariance.diagonal().minCoeff() > 0 &&
                     covariance.cwiseAbs().maxCoeff() <= kLargestVariance;
  return sound ? std::optional(covariance) : std::nullopt;
}

std::optional<UncertainPose> read_pose(ByteReader& in) {
  const auto mean = read_mean(in);
  const auto covariance = mean ? read_covariance(in) : std::nullopt;
  if (!covariance) return std::nullopt;
  return UncertainPose{*mean, *covariance};
}

}  // namespace

std::vector<std::byte> encode(const Submap& submap) {
  std::vector<std::byte> out;
  append_pose(out, submap.T_odom_submap);
  return out;
}

std::vector<std::byte> encode(const Edge& edge) {
  std::vector<std::byte> out;
  append_le(out, edge.own_submap);
  append_le(out, edge.other);
  append_le(out, edge.other_epoch);
  append_le(out, edge.other_submap);
  append_pose(out, edge.T_own_other);
  append_le(out, edge.probability);
  return out;
}

std::vector<std::byte> encode(const Deployment& deployment) {
  std::vector<std::byte> out;
  append_le(out, deployment.ref);
  append_le(out, deployment.ref_epoch);
  append_le(out, deployment.firm);
  append_pose(out, deployment.T_ref_odom);
  return out;
}

Result<Submap> decode_submap(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const auto pose = read_pose(in);
  if (!pose || in.remaining() != 0) return Error{Errc::kMalformed, "not a submap's pose"};
  return Submap{*pose};
}

Result<Deployment> decode_deployment(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const auto ref = in.read<RobotId>();
  const auto ref_epoch = in.read<Epoch>();
  const auto firm = in.read<std::uint32_t>();
  const auto pose = read_pose(in);
  if (!pose || in.remaining() != 0 || pose->covariance.llt().info() != Eigen::Success ||
      (*ref == 0) != (*ref_epoch == 0))
    return Error{Errc::kMalformed, "not a deployment"};
  return Deployment{*pose, *ref, *ref_epoch, *firm};
}

Result<Edge> decode_edge(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  Edge edge;
  edge.own_submap = in.read<std::uint16_t>().value_or(0);
  edge.other = in.read<RobotId>().value_or(0);
  edge.other_epoch = in.read<Epoch>().value_or(0);
  edge.other_submap = in.read<std::uint16_t>().value_or(0);
  const auto pose = read_pose(in);
  edge.probability = in.read<float>().value_or(-1);
  if (!pose || in.remaining() != 0 || edge.other == 0 || !(edge.probability >= 0 && edge.probability <= 1))
    return Error{Errc::kMalformed, "not a relative pose"};
  edge.T_own_other = *pose;
  return edge;
}

}  // namespace cairn::peers
