// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/degeneracy.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace cairn::odometry {
namespace {

constexpr double kEnough = 10;

/// A world as residual rows: points and the normals of what they lie on, in base_link.
class Rows {
 public:
  explicit Rows(double normal_noise_rad = 0) : noise_(normal_noise_rad) {}

  /// Points on a rectangle about `centre`, reaching ±u and ±v from it.
  Rows& plane(const Eigen::Vector3d& centre, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int points = 1500) {
    for (int i = 0; i < points; ++i)
      add(centre + uniform_(random_) * u + uniform_(random_) * v, u.cross(v).normalized());
    return *this;
  }
  /// A round tunnel along x.
  Rows& tube(double radius, double length, int points = 3000) {
    for (int i = 0; i < points; ++i) {
      const double angle = std::numbers::pi * uniform_(random_);
      const Eigen::Vector3d n(0, std::cos(angle), std::sin(angle));
      add(radius * n + Eigen::Vector3d(length * uniform_(random_), 0, 0), n);
    }
    return *this;
  }
  Rows& add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double robust = 1) {
    const Eigen::Vector3d tilted = n + noise_ * Eigen::Vector3d(gauss_(random_), gauss_(random_), gauss_(random_));
    rows_.push_back({tilted.normalized().cast<float>(), p.cast<float>(), static_cast<float>(robust)});
    rows_.push_back({});  // as a point with one row leaves it
    return *this;
  }
  [[nodiscard]] Rows turned(const Eigen::Matrix3d& R) const {
    Rows out = *this;
    for (ResidualRow& row : out.rows_) row = {R.cast<float>() * row.normal, R.cast<float>() * row.point, row.robust};
    return out;
  }

  [[nodiscard]] std::vector<Vector6> jacobians() const {
    std::vector<Vector6> out;
    for (const ResidualRow& row : rows_)
      if (row.robust > 0)
        out.push_back(
            (Vector6() << row.normal.cast<double>(), row.point.cast<double>().cross(row.normal.cast<double>()))
                .finished());
    return out;
  }
  [[nodiscard]] NormalEquations equations() const {
    NormalEquations n;
    for (const ResidualRow& row : rows_) {
      n.weight += static_cast<double>(row.robust);
      n.squared_range += static_cast<double>(row.robust * row.point.squaredNorm());
    }
    for (const Vector6& a : jacobians()) {
      n.aa += a * a.transpose();
      n.taa += 0.05 * a * a.transpose();
      n.ttaa += 0.0025 * a * a.transpose();
      n.ar += 0.3 * a;
      n.tar += 0.015 * a;
    }
    return n;
  }
  [[nodiscard]] Degeneracy degeneracy(double enough = kEnough) const {
    return find_degeneracy(equations(), rows_, enough);
  }

 private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  std::normal_distribution<double> gauss_{0, 1};
  double noise_;
  std::vector<ResidualRow> rows_;
};

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kY = Eigen::Vector3d::UnitY(), kZ = Eigen::Vector3d::UnitZ();

Rows floor(double noise = 0) { return Rows(noise).plane(-0.5 * kZ, 8 * kX, 6 * kY); }
Rows corridor(double noise = 0) {
  Rows rows = floor(noise);
  return rows.plane(2 * kY, 8 * kX, kZ).plane(-2 * kY, 8 * kX, kZ);
}
Rows room(double noise = 0) {
  Rows rows = corridor(noise);
  return rows.plane(5 * kX, 2 * kY, kZ).plane(-5 * kX, 2 * kY, kZ);
}

struct World {
  const char* name;
  Rows rows;
  int unknown;
};

std::vector<World> worlds(double noise = 0) {
  Rows wall_and_floor = floor(noise);
  wall_and_floor.plane(3 * kY, 8 * kX, 2 * kZ);
  return {{"nothing", Rows(noise), 6},      {"floor", floor(noise), 3}, {"floor and a wall", wall_and_floor, 1},
          {"corridor", corridor(noise), 1}, {"room", room(noise), 0},   {"tunnel", Rows(noise).tube(2, 8), 2}};
}

Matrix6 turn_both(const Eigen::Matrix3d& R) {
  Matrix6 B = Matrix6::Zero();
  B.topLeftCorner<3, 3>() = B.bottomRightCorner<3, 3>() = R;
  return B;
}

TEST(Degeneracy, CountsTheNullSpaceOfThePerfectWorld) {
  for (const World& world : worlds()) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6, 6);
    for (const Vector6& a : world.rows.jacobians()) A += a * a.transpose();
    Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    lu.setThreshold(1e-6);
    EXPECT_EQ(world.rows.degeneracy().count, static_cast<int>(lu.dimensionOfKernel())) << world.name;
    EXPECT_EQ(world.rows.degeneracy().count, world.unknown) << world.name;
  }
}

TEST(Degeneracy, NoisyNormalsOfThousandsOfPointsDoNotHideIt) {
  for (const World& world : worlds(0.05)) EXPECT_EQ(world.rows.degeneracy().count, world.unknown) << world.name;
}

TEST(Degeneracy, TurnsWithTheWorld) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss(0, 1);
  for (const World& world : worlds()) {
    const Degeneracy straight = world.rows.degeneracy();
    for (int i = 0; i < 10; ++i) {
      const Eigen::Quaterniond q(gauss(random), gauss(random), gauss(random), gauss(random));
      const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
      const Degeneracy turned = world.rows.turned(R).degeneracy();
      EXPECT_EQ(turned.count, straight.count) << world.name;
      EXPECT_NEAR(turned.length_m, straight.length_m, 1e-5);
      const Matrix6 expected = turn_both(R) * straight.undetermined * turn_both(R).transpose();
      EXPECT_LT((turned.undetermined - expected).norm(), 1e-4) << world.name;
    }
  }
}

TEST(Degeneracy, NamesTheDirectionsThatAreFree) {
  const Degeneracy along = corridor().degeneracy();
  ASSERT_EQ(along.count, 1);
  EXPECT_NEAR(std::abs(along.directions[0][0]), 1, 1e-6) << "along the corridor";
  const Degeneracy plane = floor().degeneracy();
  for (const Eigen::Index free : {0, 1, 5})
    EXPECT_LT((plane.undetermined * Vector6::Unit(free) - Vector6::Unit(free)).norm(), 1e-5) << free;
  for (const Eigen::Index known : {2, 3, 4})
    EXPECT_LT((plane.keep.transpose() * Vector6::Unit(known) - Vector6::Unit(known)).norm(), 1e-5) << known;
}

TEST(Degeneracy, CountsPointsThatFaceTheDirectionByTheirRobustWeight) {
  const auto with_end = [](int points, double robust) {
    Rows rows = corridor();
    for (int i = 0; i < points; ++i) rows.add({5, 0, 0}, kX, robust);
    return rows.degeneracy().count;
  };
  EXPECT_EQ(with_end(9, 1), 1);
  EXPECT_EQ(with_end(11, 1), 0);
  EXPECT_EQ(with_end(18, 0.5), 1);
  EXPECT_EQ(with_end(22, 0.5), 0);
}

TEST(Degeneracy, ProjectsTheEquationsOntoWhatIsKnown) {
  for (const World& world : worlds(0.02)) {
    const NormalEquations all = world.rows.equations();
    const Degeneracy d = world.rows.degeneracy();
    EXPECT_LT((d.undetermined * d.undetermined - d.undetermined).norm(), 1e-9) << "a projection";
    EXPECT_NEAR(d.undetermined.trace(), d.count, 1e-9);
    EXPECT_LT((d.keep + d.undetermined.transpose() - Matrix6::Identity()).norm(), 1e-12);
    const NormalEquations known = without_degenerate(all, d);
    const double size = all.aa.norm();
    EXPECT_LE((known.aa * d.undetermined).norm(), 1e-9 * size) << world.name;
    EXPECT_LE((known.taa * d.undetermined).norm(), 1e-9 * size);
    EXPECT_LE((known.ttaa * d.undetermined).norm(), 1e-9 * size);
    EXPECT_LE((known.ar.transpose() * d.undetermined).norm(), 1e-9 * size);
    EXPECT_LE((known.tar.transpose() * d.undetermined).norm(), 1e-9 * size);
    const Matrix6 K = d.keep.transpose();  // motions that are known
    EXPECT_LE((K.transpose() * (known.aa - all.aa) * K).norm(), 1e-9 * size) << "of these, nothing is lost";
    EXPECT_LE((K.transpose() * (known.ar - all.ar)).norm(), 1e-9 * size);
  }
}

}  // namespace
}  // namespace cairn::odometry
