// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/track.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace cairn::people {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;

constexpr double kAcceleration = 1.5;                          // m/s², 1 σ: people turn and stop
constexpr double kFirstPlace = 0.15, kFirstSpeed = 1.0;        // m and m/s, 1 σ
constexpr double kPrior = -2;                                  // nats: few person-sized things are people
constexpr double kLeast = -4, kMost = 8;                       // nats
constexpr double kWalk = 0.7, kSlowest = 0.4, kFastest = 2.8;  // m and m/s
constexpr double kAside = 0.25;                                // m from the line
constexpr double kWalkTime = 0.9;                              // s
constexpr double kSeenShare = 0.7;
constexpr double kStanding = 0.25;       // m/s
constexpr double kDoubtPerSecond = 0.4;  // nats

}  // namespace

Track::Track(Time stamp, const Vector2d& position, float ground, std::int32_t body)
    : state_(position.x(), position.y(), 0, 0), began_(stamp), last_seen_(stamp), last_sure_(stamp), evidence_(kPrior) {
  covariance_ = Matrix4d::Zero();
  covariance_.diagonal() << Eigen::Vector2d::Constant(kFirstPlace * kFirstPlace),
      Eigen::Vector2d::Constant(kFirstSpeed * kFirstSpeed);
  person_.stamp = stamp;
  person_.ground = ground;
  person_.seen = true;
  publish();
  steps_.push_back({stamp, position, body});
}

void Track::publish() {
  person_.position = state_.head<2>();
  person_.velocity = state_.tail<2>();
  person_.covariance = covariance_.topLeftCorner<2, 2>();
}

void Track::predict(Time stamp) {
  const double dt = to_seconds(stamp - person_.stamp);
  Matrix4d F = Matrix4d::Identity();
  F(0, 2) = F(1, 3) = dt;
  Eigen::Matrix<double, 4, 2> G;
  G << 0.5 * dt * dt * Matrix2d::Identity(), dt * Matrix2d::Identity();
  state_ = F * state_;
  covariance_ = F * covariance_ * F.transpose() + kAcceleration * kAcceleration * G * G.transpose();
  person_.stamp = stamp;
  person_.seen = false;
  publish();
  steps_.push_back({stamp, person_.position, -1});
  while (stamp - steps_.front().stamp > kMemory) steps_.pop_front();
}

double Track::distance2(const Vector2d& position, double sigma_m) const {
  const Matrix2d S = covariance_.topLeftCorner<2, 2>() + sigma_m * sigma_m * Matrix2d::Identity();
  const Vector2d off = position - state_.head<2>();
  return off.dot(S.inverse() * off);
}

void Track::update(const Vector2d& position, double sigma_m, std::int32_t body) {
  const Matrix2d S = covariance_.topLeftCorner<2, 2>() + sigma_m * sigma_m * Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> K = covariance_.leftCols<2>() * S.inverse();
  state_ += K * (position - state_.head<2>());
  covariance_ -= K * covariance_.topRows<2>();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  person_.seen = true;
  last_seen_ = person_.stamp;
  publish();
  if (!steps_.empty() && steps_.back().stamp == person_.stamp) steps_.back() = {person_.stamp, position, body};
}

void Track::weigh(double nats) { evidence_ = std::clamp(evidence_ + nats, kLeast, kMost); }

void Track::doubt(double dt_s) {
  if (person_.velocity.norm() < kStanding) weigh(-kDoubtPerSecond * dt_s);
}

bool Track::walked() const {
  if (steps_.size() < 3) return false;
  const Step &first = steps_.front(), &last = steps_.back();
  const double time = to_seconds(last.stamp - first.stamp);
  const Vector2d way = last.position - first.position;
  const double length = way.norm();
  if (time < kWalkTime || length < kWalk || length < kSlowest * time || length > kFastest * time) return false;
  const auto aside = [&](const Step& s) {
    const Vector2d to = s.position - first.position;
    return std::abs(way.x() * to.y() - way.y() * to.x()) / length;
  };
  const auto seen = std::ranges::count_if(steps_, [](const Step& s) { return s.body >= 0; });
  return static_cast<double>(seen) >= kSeenShare * static_cast<double>(steps_.size()) &&
         std::ranges::all_of(steps_, [&](const Step& s) { return aside(s) < kAside; });
}

}  // namespace cairn::people
