// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/motion_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

namespace cairn::odometry {
namespace {

constexpr double kDt = 0.1;
const MotionNoise kNoise = MotionNoise::of(3.0, 2.0);
const MotionNoise kSilence = MotionNoise::of(0.0, 0.0);

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double gauss() { return gauss_(random_); }
  template <int N>
  Eigen::Matrix<double, N, 1> vector() {
    return Eigen::Matrix<double, N, 1>::NullaryExpr([this](Eigen::Index) { return gauss(); });
  }
  /// Positive definite, of about `size`.
  template <int N>
  Eigen::Matrix<double, N, N> covariance(double size) {
    Eigen::Matrix<double, N, N> B;
    for (Eigen::Index k = 0; k < N; ++k) B.col(k) = vector<N>();
    return size * (B * B.transpose() / N + 0.1 * Eigen::Matrix<double, N, N>::Identity());
  }
  MotionState state() { return {SE3::exp(vector<6>()), 0.7 * vector<6>()}; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> gauss_{0, 1};
};

/// Of any size, and Cholesky's decomposition alone: with fixed sizes and other solvers this file took 20 s to compile.
using Matrix = Eigen::MatrixXd;
using Cholesky = Eigen::LLT<Matrix>;

/// The covariance of A x where P is that of x.
Matrix carried(const Matrix& A, const Matrix& P) { return A * P * A.transpose(); }

bool eigenvalues_exceed(double bound, const Matrix& P) {
  return Cholesky(P - bound * Matrix::Identity(P.rows(), P.rows())).info() == Eigen::Success;
}

/// Points as the filter gets them, and the same as plain rows of r = r₀ + A e.
struct Observations {
  NormalEquations equations;
  Matrix A;
  Eigen::VectorXd r, weight;

  Observations(Random& random, Eigen::Index n) : A(n, 12), r(n), weight(n) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector6 a = random.vector<6>();
      const double tau = 0.05 * (1 + std::tanh(random.gauss())), w = 200 * (1.2 + std::tanh(random.gauss()));
      r[i] = 0.02 * random.gauss();
      weight[i] = w;
      A.row(i) << a.transpose(), -tau * a.transpose();
      equations.aa += w * a * a.transpose();
      equations.taa += tau * w * a * a.transpose();
      equations.ttaa += tau * tau * w * a * a.transpose();
      equations.ar += w * r[i] * a;
      equations.tar += tau * w * r[i] * a;
    }
  }
  [[nodiscard]] Matrix gain(const Matrix& P, double overconfidence) const {
    Matrix S = carried(A, P);
    S.diagonal() += overconfidence * weight.cwiseInverse();
    return Cholesky(S).solve(A * P).transpose();
  }
};

Vector12 difference(const MotionState& a, const MotionState& b) {
  return (Vector12() << (b.T_odom_base.inverse() * a.T_odom_base).log(), a.twist - b.twist).finished();
}

/// Constant twist, by the definition.
MotionState moved(const MotionState& x, double dt) { return {x.T_odom_base * SE3::exp(dt * x.twist), x.twist}; }

Matrix12 numerical_transition(const MotionState& x, double dt) {
  constexpr double h = 1e-6;
  Matrix12 F;
  for (Eigen::Index i = 0; i < 12; ++i) {
    const Vector12 e = h * Vector12::Unit(i);
    F.col(i) = (difference(moved(x + e, dt), moved(x, dt)) - difference(moved(x + -e, dt), moved(x, dt))) / (2 * h);
  }
  return F;
}

void expect_covariance(const Matrix& P) {
  EXPECT_EQ(P, Matrix(P.transpose()));
  EXPECT_TRUE(eigenvalues_exceed(-1e-12 * P.norm(), P));
}

double relative_difference(const Matrix& a, const Matrix& b) { return (a - b).norm() / b.norm(); }

MotionFilter random_filter(Random& random) {
  MotionFilter filter;
  filter.reset(random.state(), {random.covariance<12>(1e-3), random.covariance<12>(1e-2)});
  return filter;
}

TEST(MotionFilter, PredictionCarriesStateAndCovarianceAsNumericalDerivativesDo) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    MotionFilter filter = random_filter(random);
    const MotionState x = filter.state();
    const MotionFilter::Uncertainty before = filter.uncertainty();
    filter.predict(kDt, kSilence);
    EXPECT_LT(difference(filter.state(), moved(x, kDt)).norm(), 1e-12);
    const Matrix F = numerical_transition(x, kDt);
    EXPECT_LT(relative_difference(filter.uncertainty().local, carried(F, before.local)), 1e-6);
    EXPECT_LT(relative_difference(filter.uncertainty().total, carried(F, before.total)), 1e-6);
  }
}

TEST(MotionFilter, SurpriseCountsStandardDeviationsOfThePose) {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    MotionFilter filter = random_filter(random);
    const SE3& here = filter.state().T_odom_base;
    EXPECT_EQ(filter.squared_surprise(here), 0);
    const Matrix6 P = filter.uncertainty().local.topLeftCorner<6, 6>();
    const Eigen::SelfAdjointEigenSolver<Matrix6> axes(P);
    const Vector6 three_sigma = 3 * std::sqrt(axes.eigenvalues()[i % 6]) * axes.eigenvectors().col(i % 6);
    EXPECT_NEAR(filter.squared_surprise(here * SE3::exp(three_sigma)), 9, 1e-6);
  }
}

TEST(MotionFilter, AccelerationAddsAtLeastWhatAConstantOneWouldAndIsInvertible) {
  Random random(2);
  MotionFilter with = random_filter(random), without = with;
  with.predict(kDt, kNoise);
  without.predict(kDt, kSilence);
  const Matrix12 Q = with.uncertainty().local - without.uncertainty().local;
  EXPECT_LT(relative_difference(with.uncertainty().total - without.uncertainty().total, Q), 1e-9);
  Vector6 a;
  a << 3, 3, 3, 2, 2, 2;
  Eigen::Matrix<double, 12, 6> effect;  // of a constant acceleration
  effect << 0.5 * kDt * kDt * Matrix6(a.asDiagonal()), kDt * Matrix6(a.asDiagonal());
  EXPECT_TRUE(eigenvalues_exceed(-1e-9, Matrix(Q) - carried(effect, Matrix6::Identity())));
  EXPECT_TRUE(eigenvalues_exceed(1e-7, Q));
  EXPECT_LT(relative_difference(Q.diagonal().tail<6>(), effect.bottomRows<6>().diagonal().cwiseAbs2()), 1e-9);
}

TEST(MotionFilter, OneStepIsTheKalmanFiltersMeanOfPointAfterPoint) {
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    MotionFilter filter = random_filter(random);
    filter.predict(kDt, kNoise);
    const Observations seen(random, 40);
    const double over = 7;
    Matrix12 P = filter.uncertainty().local;
    Vector12 e = Vector12::Zero();
    for (Eigen::Index k = 0; k < seen.r.size(); ++k) {
      const Vector12 a = seen.A.row(k).transpose();
      const Vector12 gain = P * a / (a.dot(P * a) + over / seen.weight[k]);
      e -= gain * (seen.r[k] + a.dot(e));
      P -= Matrix12(gain * (P * a).transpose());
    }
    const Measurement m{seen.equations, {}, over};
    const Vector12 step = filter.step(filter.state(), m);
    EXPECT_LT(relative_difference(step, e), 1e-6);
    filter.update(filter.state() + step, m, Matrix6::Zero());
    EXPECT_LT(relative_difference(filter.uncertainty().local, P), 1e-6);
  }
}

TEST(MotionFilter, FromElsewhereAStepLeadsToTheSamePlace) {
  Random random(4);
  MotionFilter filter = random_filter(random);
  filter.predict(kDt, kNoise);
  Observations seen(random, 40);
  const Vector12 direct = filter.step(filter.state(), {seen.equations, {}, 1});
  const Vector12 off = 1e-3 * random.vector<12>();
  // The same residuals, linearised where the iteration has come to.
  const Eigen::VectorXd there = seen.r + seen.A * off;
  const Eigen::VectorXd weighted = seen.weight.cwiseProduct(there);
  const Vector12 gradient = seen.A.transpose() * weighted;
  seen.equations.ar = gradient.head<6>();
  seen.equations.tar = -gradient.tail<6>();
  const MotionState x = filter.state() + off;
  const Vector12 rest = filter.step(x, {seen.equations, {}, 1});
  EXPECT_LT((difference(x + rest, filter.state()) - direct).norm(), 0.02 * direct.norm());
}

TEST(MotionFilter, ErrorsOfPredictionPointsAndMapAddUpAsTheGainsSay) {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    MotionFilter filter = random_filter(random);
    const SE3 T_before = filter.state().T_odom_base;
    const Matrix F = numerical_transition(filter.state(), kDt), before = filter.uncertainty().local;
    filter.predict(kDt, kNoise);
    const MotionFilter::Uncertainty predicted = filter.uncertainty();
    const Matrix Q = predicted.local - carried(F, before);
    const Observations seen(random, 40);
    const double over = 3;
    const Matrix6 map = random.covariance<6>(1e-4);
    filter.update(filter.state(), {seen.equations, {}, over}, map);

    const Matrix K = seen.gain(predicted.local, over);
    const Matrix keep = Matrix::Identity(12, 12) - K * seen.A;
    const Matrix noise = carried(K, over * Matrix(seen.weight.cwiseInverse().asDiagonal()));
    // A map that is displaced by ξ on the left moves every residual as a base displaced by −ξ would.
    const Matrix T = filter.state().T_odom_base.inverse().adjoint();
    const Matrix follow = K * Matrix(seen.A.leftCols<6>()) * T;
    const Matrix total = carried(keep, predicted.total) + noise + carried(follow, map);
    EXPECT_LT(relative_difference(filter.uncertainty().total, total), 1e-5);

    Matrix moved_on = Matrix::Zero(12, 12);
    moved_on.topLeftCorner<6, 6>() = (T_before.inverse() * filter.state().T_odom_base).inverse().adjoint();
    const Matrix G = keep * F - moved_on;
    const Matrix motion = carried(G, before) + carried(keep, Q) + noise;
    EXPECT_LT(relative_difference(filter.step_covariance(), motion.topLeftCorner<6, 6>()), 1e-5);
  }
}

TEST(MotionFilter, CovariancesStaySymmetricAndPositiveOverALongRide) {
  Random random(6);
  MotionFilter filter = random_filter(random);
  Degeneracy sliding;
  sliding.count = 1;
  sliding.undetermined(0, 0) = 1;
  sliding.keep(0, 0) = 0;
  for (int i = 0; i < 300; ++i) {
    filter.predict(kDt, kNoise);
    expect_covariance(filter.uncertainty().local);
    const Observations seen(random, 30);
    const Degeneracy d = i % 3 == 0 ? sliding : Degeneracy{};
    const NormalEquations n = without_degenerate(seen.equations, d);
    const Measurement m{n, d, 40};
    const double unknown = filter.uncertainty().local(0, 0);
    filter.update(filter.state() + filter.step(filter.state(), m), m, random.covariance<6>(1e-5));
    expect_covariance(filter.uncertainty().local);
    expect_covariance(filter.uncertainty().total);
    if (d.count == 1) {
      EXPECT_GE(filter.uncertainty().local(0, 0), 0.999 * unknown) << "nothing was learnt along x";
    }
  }
}

/// One step of a base whose acceleration is white within it too.
MotionState driven(MotionState x, Random& random) {
  constexpr int kParts = 10;
  for (int i = 0; i < kParts; ++i) {
    Vector6 acceleration;
    acceleration = kNoise.acceleration.cwiseProduct(random.vector<6>());
    x.twist += kDt / std::sqrt(kParts) * acceleration;
    x = moved(x, kDt / kParts);
  }
  return x;
}

/// Truth drawn from the model, poses measured directly: the mean squared error in units of the covariance is 12.
TEST(MotionFilter, ItsCovarianceIsThatOfItsErrors) {
  Random random(7);
  const double sigma = 0.01;
  double nees = 0;
  int n = 0;
  for (int ride = 0; ride < 40; ++ride) {
    const Matrix12 P = random.covariance<12>(1e-3);
    MotionState truth = random.state();
    MotionFilter filter;
    filter.reset(truth + Vector12(Matrix(Cholesky(P).matrixL()) * random.vector<12>()), {P, P});
    for (int i = 0; i < 25; ++i) {
      truth = driven(truth, random);
      filter.predict(kDt, kNoise);
      const SE3 measured = truth.T_odom_base * SE3::exp(sigma * random.vector<6>());
      NormalEquations equations;
      equations.aa = Matrix6::Identity() / (sigma * sigma);
      equations.ar = equations.aa * (measured.inverse() * filter.state().T_odom_base).log();
      const Measurement m{equations, {}, 1};
      filter.update(filter.state() + filter.step(filter.state(), m), m, Matrix6::Zero());
      const Vector12 e = difference(truth, filter.state());
      nees += e.dot(Vector12(Cholesky(filter.uncertainty().total).solve(Matrix(e))));
      ++n;
    }
  }
  EXPECT_NEAR(nees / n, 12, 1);
}

}  // namespace
}  // namespace cairn::odometry
