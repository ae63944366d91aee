// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_submaps.hpp"

#include "fusion/peers/items/claim.hpp"

namespace cairn::peers {
namespace {

constexpr double kStep_m = 0.2;  // shorter steps are the noise of a robot that stands

}  // namespace

void OwnSubmaps::be_at(const Eigen::Vector3d& position_odom, Exchange& exchange) {
  const double step = placed_ ? (position_odom - last_).norm() : 0;
  if (placed_ && step < kStep_m) return;
  placed_ = true;
  last_ = position_odom;
  path_m_ += step;
  if (path_m_ >= config_.length_m && current_ + 1 < kMost) begin_next(exchange);
}

void OwnSubmaps::begin_next(Exchange& exchange) {
  Submap submap;
  const Eigen::Vector3d tiles = (last_ / tile_m_).array().round();
  submap.T_odom_submap.mean = SE3(Eigen::Quaterniond::Identity(), tiles * tile_m_);
  Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(config_.drift_m_per_m), Eigen::Vector3d::Constant(config_.drift_rad_per_m);
  submap.T_odom_submap.covariance = (path_m_ * sigma).cwiseAbs2().asDiagonal();
  exchange.say(ItemId::submap(++current_), encode(submap));
  path_m_ = 0;
}

}  // namespace cairn::peers
