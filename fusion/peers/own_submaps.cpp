// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_submaps.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "fusion/peers/items/claim.hpp"
#include "hal/symmetric_eigen.hpp"

namespace cairn::peers {
namespace {

constexpr double kStep_m = 0.2;  // shorter steps are the noise of a robot that stands

/// What the covariance has grown by, as that of a right perturbation at `after`: errors since are independent of those
/// before. Odometry that meets its own old map forgets a part of its errors, and does not know of which. So what place
/// and heading have in common is left out: it would hold large values of no meaning.
Matrix6 growth(const UncertainPose& before, const UncertainPose& after) {
  const Matrix6 carried = (after.mean.inverse() * before.mean).adjoint();
  Matrix6 grown = after.covariance - carried * before.covariance * carried.transpose();
  grown.topRightCorner<3, 3>().setZero();
  grown.bottomLeftCorner<3, 3>().setZero();
  return grown;
}

/// Of the covariance, where the floor is the unit.
SymmetricEigen in_units_of(const Matrix6& floor, const Matrix6& covariance) {
  const Vector6 unit = floor.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6 scaled = unit.asDiagonal() * covariance * unit.asDiagonal();
  return symmetric_eigen(0.5 * (scaled + scaled.transpose()));
}

}  // namespace

Matrix6 at_least(const Matrix6& covariance, const Matrix6& floor) {
  if (!covariance.allFinite()) return floor;
  const auto in_units = in_units_of(floor, covariance);
  if (!in_units.converged || in_units.values.maxCoeff() <= 1) return floor;
  const Vector6 values = in_units.values.cwiseMax(1).cwiseMin(kMostTimes);
  const Vector6 unit = floor.diagonal().cwiseSqrt();
  const Matrix6& axes = in_units.vectors;
  return unit.asDiagonal() * (axes * values.asDiagonal() * axes.transpose()) * unit.asDiagonal();
}

void OwnSubmaps::be_at(const UncertainPose& T_odom_base, Exchange& exchange) {
  if (!last_) begun_ = last_ = T_odom_base;
  const double step = (T_odom_base.mean.translation() - last_->mean.translation()).norm();
  if (step < kStep_m) return;
  last_ = T_odom_base;
  path_m_ += step;
  if (path_m_ >= config_.length_m) begin_next(at_least(grown(), expected(path_m_)), exchange);
}

void OwnSubmaps::cut(Exchange& exchange) {
  if (last_) begin_next(at_least(grown(), expected(config_.length_m)), exchange);
}

Matrix6 OwnSubmaps::expected(double path_m) const {
  Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(config_.drift_m_per_m), Eigen::Vector3d::Constant(config_.drift_rad_per_m);
  return (path_m * sigma).cwiseAbs2().asDiagonal();
}

SE3 OwnSubmaps::next_place() const {
  const Eigen::Vector3d tiles = (last_->mean.translation() / tile_m_).array().round();
  return {Eigen::Quaterniond::Identity(), tiles * tile_m_};
}

/// Since the submap began, as that of a right perturbation where the next one would be.
Matrix6 OwnSubmaps::grown() const {
  const Matrix6 carried = (next_place().inverse() * last_->mean).adjoint();
  return carried * growth(*begun_, *last_) * carried.transpose();
}

void OwnSubmaps::begin_next(const Matrix6& drift, Exchange& exchange) {
  if (current_ + 1 >= kMost) return;
  exchange.say(ItemId::submap(++current_), encode(Submap{.T_odom_submap = {next_place(), drift}}));
  begun_ = last_;
  path_m_ = 0;
}

}  // namespace cairn::peers
