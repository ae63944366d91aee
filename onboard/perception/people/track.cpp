// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/track.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace cairn::people {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;

constexpr double kAcceleration = 1.5;                          // m/s², 1 σ: people turn and stop
constexpr double kFirstPlace = 0.15, kFirstSpeed = 1.0;        // m and m/s, 1 σ
constexpr double kPrior = -2;                                  // nats: few person-sized things are people
constexpr double kLeast = -5, kMost = 8;                       // nats
constexpr double kWalk = 0.7, kSlowest = 0.4, kFastest = 2.8;  // m and m/s
constexpr double kAside = 0.25;                                // m from the line
constexpr double kWalkTime = 0.9;                              // s
constexpr double kKeepsPace = 1;                               // s; who is not seen may have turned
constexpr double kSeenShare = 0.7;
constexpr double kWalkEvidence = 6.5;                         // nats: confirms, whatever the prior says
constexpr double kStanding = 0.25;                            // m/s
constexpr double kSlowly = 0.6, kSoon = 2, kAtOnce = 3;       // nats a second
constexpr double kLongestScan = 0.5;                          // s
constexpr Duration kFresh = std::chrono::milliseconds(1000);  // a detector's sighting
constexpr float kMapped = 0.5F;                               // of the points

Matrix4d first_covariance() {
  return Eigen::Vector4d(kFirstPlace * kFirstPlace, kFirstPlace * kFirstPlace, kFirstSpeed * kFirstSpeed,
                         kFirstSpeed * kFirstSpeed)
      .asDiagonal();
}

}  // namespace

Track::Track(Time stamp, const Vector2d& position, float ground, std::int32_t body)
    : state_(position.x(), position.y(), 0, 0), began_(stamp), last_seen_(stamp), last_sure_(stamp), evidence_(kPrior) {
  covariance_ = first_covariance();
  person_.stamp = stamp;
  person_.ground = ground;
  person_.seen = true;
  publish();
  steps_.push_back({stamp, position, body, ground});
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
  if (!person_.seen) state_.tail<2>() *= std::exp(-dt / kKeepsPace);
  covariance_ = F * covariance_ * F.transpose() + kAcceleration * kAcceleration * G * G.transpose();
  person_.stamp = stamp;
  person_.seen = false;
  publish();
  steps_.push_back({stamp, person_.position, -1, person_.ground});
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
  misses_ = 0;
  publish();
  if (!steps_.empty() && steps_.back().stamp == person_.stamp)
    steps_.back() = {person_.stamp, position, body, person_.ground};
}

void Track::restart(const Vector2d& position, std::int32_t body) {
  state_ << position, 0, 0;
  covariance_ = first_covariance();
  person_.seen = true;
  last_seen_ = person_.stamp;
  misses_ = 0;
  publish();
  steps_.assign(1, {person_.stamp, position, body, person_.ground});
}

void Track::weigh(double nats) { evidence_ = std::clamp(evidence_ + nats, kLeast, kMost); }

void Track::doubt(Time stamp, const Cluster& body) {
  if (stamp - last_sighted_ < kFresh || steps_.size() < 2) return;
  const double dt_s = std::min(to_seconds(stamp - steps_[steps_.size() - 2].stamp), kLongestScan);
  const bool stands = person_.velocity.norm() < kStanding;
  if (body.known > kMapped || body.porous())
    weigh(-kAtOnce * dt_s);
  else if (stands)
    weigh(-(newcomer() && body.alone() ? kSlowly : kSoon) * dt_s);
}

void Track::walks() {
  known_walker_ = true;
  weigh(kWalkEvidence);
}

bool Track::walked() const { return walked(kWalk, kWalkTime); }

bool Track::walked(double length_m, double time_s) const {
  if (steps_.size() < 3) return false;
  const Step &first = steps_.front(), &last = steps_.back();
  const double time = to_seconds(last.stamp - first.stamp);
  const Vector2d way = last.position - first.position;
  const double length = way.norm();
  if (time < time_s || length < length_m || length < kSlowest * time || length > kFastest * time) return false;
  const auto aside = [&](const Step& s) {
    const Vector2d to = s.position - first.position;
    return std::abs(way.x() * to.y() - way.y() * to.x()) / length;
  };
  const auto seen = std::ranges::count_if(steps_, [](const Step& s) { return s.body >= 0; });
  return static_cast<double>(seen) >= kSeenShare * static_cast<double>(steps_.size()) &&
         std::ranges::all_of(steps_, [&](const Step& s) { return aside(s) < kAside; });
}

}  // namespace cairn::people
