// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/normal_equations.hpp"

#include <gtest/gtest.h>

#include <random>

#include "onboard/odometry/estimation/motion_filter.hpp"
#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

using Matrix3x12 = Eigen::Matrix<double, 3, 12>;

constexpr double kDuration = 0.1;
const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0.02, -0.05, 0.3).finished());
const SE3 kTruth = SE3::from_xyz_rpy((Vector6() << 0.7, 0.2, 0.1, 0.03, -0.02, 0.8).finished());

PatchMap room_map() {
  PatchMap map({0.5, 1 << 14, 400, {}});
  Workers workers(1);
  map.insert(Room(1).points(30000, 0.01), Room::sensor(), 3, workers);
  return map;
}

/// The scan that a base with this twist would have made of the room, a little off where the map has it.
std::vector<Keypoint> keypoints(const Vector6& twist, std::size_t n) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> age(0, kDuration);
  std::vector<Keypoint> out;
  for (const Eigen::Vector3d& p : Room(3).points(n, 0.02)) {
    const double tau = age(random);
    const SE3 T_odom_lidar = kTruth * SE3::exp(-tau * twist) * kMount;
    out.push_back({(T_odom_lidar.inverse() * p).cast<float>(), static_cast<float>(tau)});
  }
  return out;
}

Linearisation linearisation(const Vector6& twist) {
  const Vector6 off = (Vector6() << 0.02, -0.03, 0.01, 0.002, -0.003, 0.005).finished();
  return {kTruth * SE3::exp(off), twist, kMount, kDuration, 0.4};
}

Vector6 walking() { return (Vector6() << 1.2, 0.1, -0.1, 0.1, -0.2, 0.8).finished(); }

/// The keypoint in odom, for a state `change` away from the one linearised at.
Eigen::Vector3d place(const Keypoint& k, const Linearisation& at, const Vector12& change) {
  const SE3 T_stamp_firing = SE3::exp(-static_cast<double>(k.age_s) * (at.twist + change.tail<6>()));
  const SE3 T_odom_base = at.T_odom_base * SE3::exp(change.head<6>());
  return T_odom_base * (T_stamp_firing * (at.T_base_lidar * k.p_lidar.cast<double>()));
}

Matrix3x12 central_differences(const Keypoint& k, const Linearisation& at) {
  constexpr double h = 1e-5;
  Matrix3x12 J;
  for (Eigen::Index i = 0; i < 12; ++i)
    J.col(i) = (place(k, at, h * Vector12::Unit(i)) - place(k, at, -h * Vector12::Unit(i))) / (2 * h);
  return J;
}

/// The same sums, point by point with numerical derivatives; the association is the map's, the robust weights are those
/// that were used.
struct Slow {
  Matrix12 hessian = Matrix12::Zero();
  Vector12 gradient = Vector12::Zero();
  double chi2 = 0, weight = 0;
  int matched = 0, rows = 0, poles = 0;

  Slow(std::span<const Keypoint> points, const PatchMap& map, const Linearisation& at,
       std::span<const ResidualRow> used) {
    const Deskew deskew(at.twist, at.T_base_lidar, at.duration_s);
    const Eigen::Vector3d lidar = at.T_odom_base * at.T_base_lidar.translation();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f q = deskew(points[i].p_lidar, points[i].age_s);
      const Eigen::Vector3d p = at.T_odom_base * q.cast<double>();
      const PatchMatch match = map.match(p, (lidar - p).cast<float>(), static_cast<float>(at.gate_m));
      matched += match.kind != PatchMatch::Kind::kNone ? 1 : 0;
      if (match.kind != PatchMatch::Kind::kOn) continue;
      poles += match.rows == 2 ? 1 : 0;
      const Matrix3x12 J = central_differences(points[i], at);
      for (std::size_t k = 0; k < static_cast<std::size_t>(match.rows); ++k)
        add(match.row[k], J, used[2 * i + k].robust);
    }
  }
  void add(const PatchMatch::Row& row, const Matrix3x12& J, double robust) {
    const Vector12 a = J.transpose() * row.direction.cast<double>();
    const double w = robust / row.variance, r = row.distance;
    hessian += w * a * a.transpose();
    gradient += w * r * a;
    chi2 += w * r * r;
    weight += w;
    ++rows;
  }
};

Matrix12 hessian(const NormalEquations& n) {
  Matrix12 H;
  H << n.aa, -n.taa, -n.taa, n.ttaa;
  return H;
}
Vector12 gradient(const NormalEquations& n) { return (Vector12() << n.ar, -n.tar).finished(); }

template <class A, class B>
double relative_difference(const A& a, const B& b) {
  return (a - b).norm() / b.norm();
}

class NormalEquationsTest : public ::testing::Test {
 protected:
  NormalEquations fast(std::span<const Keypoint> points, const Linearisation& at, unsigned threads = 1) {
    Workers workers(threads);
    return linearise_(points, map_, at, workers);
  }
  Slow slow(std::span<const Keypoint> points, const Linearisation& at) { return {points, map_, at, linearise_.rows()}; }

  PatchMap map_ = room_map();
  Linearise linearise_{4000};
};

TEST_F(NormalEquationsTest, AtRestEveryEntryIsThatOfNumericalDerivatives) {
  const Vector6 rest = Vector6::Zero();
  const auto points = keypoints(rest, 1500);
  const NormalEquations n = fast(points, linearisation(rest));
  const Slow oracle = slow(points, linearisation(rest));
  ASSERT_GT(oracle.rows, 1000);
  ASSERT_GT(oracle.poles, 5);
  EXPECT_EQ(n.matched, oracle.matched);
  EXPECT_NEAR(n.chi2, oracle.chi2, 1e-6 * oracle.chi2);
  EXPECT_NEAR(n.weight, oracle.weight, 1e-6 * oracle.weight);
  EXPECT_LT(relative_difference(hessian(n), oracle.hessian), 1e-5);
  EXPECT_LT(relative_difference(gradient(n), oracle.gradient), 1e-5);
  for (Eigen::Index row = 0; row < 12; ++row)
    EXPECT_LT(relative_difference(hessian(n).row(row), oracle.hessian.row(row)), 1e-4) << row;
}

TEST_F(NormalEquationsTest, InMotionThePoseIsExactAndTheTwistIsOfFirstOrder) {
  const auto points = keypoints(walking(), 1500);
  const NormalEquations n = fast(points, linearisation(walking()));
  const Slow oracle = slow(points, linearisation(walking()));
  ASSERT_GT(oracle.rows, 1000);
  EXPECT_LT(relative_difference(n.aa, (oracle.hessian.topLeftCorner<6, 6>())), 1e-5);
  EXPECT_LT(relative_difference(n.ar, oracle.gradient.head<6>()), 1e-5);
  // Left out: τ·twist/2, at most 0.04 rad and 0.06 m on levers of metres.
  EXPECT_LT(relative_difference(hessian(n), oracle.hessian), 0.05);
  EXPECT_LT(relative_difference(gradient(n), oracle.gradient), 0.05);
}

TEST_F(NormalEquationsTest, FromAnAgreedAssociationOneStepHalvesTheError) {
  const auto points = keypoints(walking(), 1500);
  const Linearisation at = linearisation(walking());
  const NormalEquations n = fast(points, at);
  const Vector6 step = -n.aa.ldlt().solve(n.ar);
  const Vector6 before = (at.T_odom_base.inverse() * kTruth).log();
  const Vector6 after = ((at.T_odom_base * SE3::exp(step)).inverse() * kTruth).log();
  EXPECT_LT(after.head<3>().norm(), 0.5 * before.head<3>().norm());
  EXPECT_LT(after.tail<3>().norm(), 0.5 * before.tail<3>().norm());
}

TEST_F(NormalEquationsTest, AreTheSameBitsForAnyNumberOfThreads) {
  const auto points = keypoints(walking(), 1501);
  const NormalEquations one = fast(points, linearisation(walking()), 1);
  for (const unsigned threads : {2U, 3U}) {
    const NormalEquations many = fast(points, linearisation(walking()), threads);
    EXPECT_EQ(hessian(one), hessian(many));
    EXPECT_EQ(gradient(one), gradient(many));
    EXPECT_EQ(one.chi2, many.chi2);
    EXPECT_EQ(one.inliers, many.inliers);
  }
}

TEST_F(NormalEquationsTest, OfAWholeAreTheSumOfItsParts) {
  const auto points = keypoints(walking(), 1000);
  const Linearisation at = linearisation(walking());
  const NormalEquations whole = fast(points, at);
  NormalEquations sum = fast(std::span(points).first(333), at);
  sum += fast(std::span(points).subspan(333), at);
  EXPECT_LT(relative_difference(hessian(sum), hessian(whole)), 1e-12);
  EXPECT_LT(relative_difference(gradient(sum), gradient(whole)), 1e-12);
  EXPECT_NEAR(sum.squared_range, whole.squared_range, 1e-9 * whole.squared_range);
  EXPECT_NEAR(sum.squared_distance, whole.squared_distance, 1e-9 * whole.squared_distance);
  EXPECT_NEAR(sum.robust, whole.robust, 1e-9 * whole.robust);
  EXPECT_EQ(sum.matched, whole.matched);
  EXPECT_EQ(sum.inliers, whole.inliers);
}

TEST_F(NormalEquationsTest, APointWeighsFullyOnItsPlaneAQuarterAtThreeSigmaAndNothingBeyondTheGate) {
  const Eigen::Vector3d wall(Room::kLow.x(), 0.1, 0.4);
  const PatchMatch on = map_.match(wall, {1, 0, 0}, 0.2F);
  ASSERT_EQ(on.kind, PatchMatch::Kind::kOn);
  const double sigma = std::sqrt(on.row[0].variance);
  const auto weigh = [&](double sigmas) {
    const Eigen::Vector3d p = wall + (sigmas * sigma - on.row[0].distance) * on.row[0].direction.cast<double>();
    const std::vector<Keypoint> one{{p.cast<float>(), 0}};
    return fast(one, {{}, Vector6::Zero(), {}, 0, 0.05});
  };
  EXPECT_NEAR(weigh(0).robust, 1.0, 1e-3);
  EXPECT_NEAR(weigh(3).robust, 0.25, 1e-2);
  EXPECT_EQ(weigh(2.9).inliers, 1);
  EXPECT_EQ(weigh(3.1).inliers, 0);
  EXPECT_EQ(weigh(0.06 / sigma).weight, 0);
  EXPECT_EQ(weigh(0.06 / sigma).matched, 1);
}

TEST_F(NormalEquationsTest, OnFreshWallsAndPolesPointsCountTheirShareOnFreshFloorsFully) {
  PatchMap::Config config{0.5, 1 << 14, 400, {}};
  config.lasting_s = 1;
  PatchMap fresh(config);
  Workers workers(1);
  PatchGrid::Sensor sensor = Room::sensor();
  sensor.time_s = 5;
  fresh.insert(Room(1).points(30000, 0.01), sensor, 3, workers);
  const auto points = keypoints(walking(), 1500);
  Linearisation at = linearisation(walking());
  const NormalEquations whole = linearise_(points, fresh, at, workers);
  const std::vector<ResidualRow> before(linearise_.rows().begin(), linearise_.rows().end());
  at.fresh_share = 0.25;
  const NormalEquations part = linearise_(points, fresh, at, workers);
  int level = 0, others = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].robust == 0) continue;
    const Eigen::Vector3f normal_odom = at.T_odom_base.rotation().cast<float>() * before[i].normal;
    const bool floor = std::abs(normal_odom.z()) > kLevelCosine;
    (floor ? level : others) += 1;
    EXPECT_EQ(linearise_.rows()[i].robust, (floor ? 1.0F : 0.25F) * before[i].robust);
  }
  EXPECT_GT(level, 300);
  EXPECT_GT(others, 600);
  EXPECT_LT(part.weight, 0.9 * whole.weight);
  EXPECT_EQ(part.inliers, whole.inliers) << "it fits all the same";
}

}  // namespace
}  // namespace cairn::odometry
