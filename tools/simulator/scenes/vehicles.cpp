// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/vehicles.hpp"

#include <cmath>
#include <numbers>

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

/// A bar between two points of the placement's middle plane (forward, up), as a thin box of triangles.
void bar(Mesh& m, const Placement& p, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thick,
         Material paint) {
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d across = 0.5 * thick * Eigen::Vector2d(-along.y(), along.x());
  const auto at = [&](const Eigen::Vector2d& q, double side) {
    return p * Eigen::Vector3d(q.x(), side * thick / 2, q.y());
  };
  for (const double side : {-1.0, 1.0}) {
    m.quad(at(from - across, side), at(from + across, side), at(to + across, side), at(to - across, side), paint);
    m.quad(at(from + side * across, -1), at(from + side * across, 1), at(to + side * across, 1),
           at(to + side * across, -1), paint);
  }
}

/// A ring of spokes' width instead of a disc: one looks through a bicycle's wheel.
void rim(Mesh& m, const Placement& p, double forward, double radius, Material paint) {
  constexpr int kSegments = 16;
  const auto on = [&](int i) -> Eigen::Vector2d {
    const double a = 2 * kPi * (i % kSegments) / kSegments;
    return {forward + radius * std::cos(a), radius * (1 + std::sin(a)) + 0.01};
  };
  for (int i = 0; i < kSegments; ++i) bar(m, p, on(i), on(i + 1), 0.035, paint);
  for (int i = 0; i < 4; ++i) bar(m, p, on(i), on(i + kSegments / 2), 0.006, paint);
}

void windows(Mesh& m, const Placement& p, double length, double half_width, double low, double high, int panes,
             Material glass = Material::kVehicleGlass) {
  const double pane = length / panes;
  for (int i = 0; i < panes; ++i) {
    const double x0 = -0.5 * length + i * pane + 0.06, x1 = x0 + pane - 0.12;
    for (const double y : {-half_width, half_width}) {
      m.quad(p * Eigen::Vector3d(x0, y, low), p * Eigen::Vector3d(x1, y, low), p * Eigen::Vector3d(x1, y, high),
             p * Eigen::Vector3d(x0, y, high), glass);
    }
  }
}

}  // namespace

void car(Mesh& m, const Placement& p, CarKind kind, Material paint) {
  const bool van = kind == CarKind::kVan;
  const double length = van ? 4.9 : kind == CarKind::kSedan ? 4.6 : 3.9, width = van ? 1.9 : 1.75;
  const double waist = van ? 1.05 : 0.88, height = van ? 1.95 : 1.45;
  const double cabin = van ? 0.8 * length : kind == CarKind::kSedan ? 0.55 * length : 0.66 * length;
  const double cabin_at = van ? -0.35 : kind == CarKind::kSedan ? -0.1 : -0.45;
  m.frustum(p.at(0, 0, 0.22), length, width, length - 0.15, width - 0.08, 0, waist - 0.22, paint);
  m.frustum(p.at(cabin_at, 0, waist), cabin, width - 0.12, 0.68 * cabin, width - 0.42, -0.1, height - waist - 0.02,
            Material::kVehicleGlass);
  m.box(p.at(cabin_at - 0.1, 0, height - 0.03), 0.66 * cabin, width - 0.44, 0.04, paint);
  for (const double x : {-0.31, 0.31}) {
    for (const double y : {-0.5, 0.5}) {
      m.wheel(p.at(x * length, y * (width - 0.18), 0.31), 0.31, 0.21, Material::kTyre);
    }
  }
  for (const double end : {-0.5, 0.5}) {
    m.box(p.at(end * (length + 0.01), 0, 0.45), 0.03, 0.52, 0.11, Material::kRetroreflector);
  }
  for (const double side : {-0.5, 0.5}) {
    m.box(p.at(0.22 * length, side * (width + 0.16), waist), 0.12, 0.18, 0.12, paint);
  }
}

void bus(Mesh& m, const Placement& p) {
  m.frustum(p.at(0, 0, 0.3), 11.5, 2.5, 11.4, 2.4, 0, 2.7, Material::kBusPaint);
  windows(m, p.at(0.2, 0), 10.6, 1.262, 1.3, 2.5, 8);
  m.quad(p * Eigen::Vector3d(5.78, -1.1, 1.1), p * Eigen::Vector3d(5.78, 1.1, 1.1), p * Eigen::Vector3d(5.74, 1.1, 2.6),
         p * Eigen::Vector3d(5.74, -1.1, 2.6), Material::kVehicleGlass);
  for (const double x : {-3.2, 3.4}) {
    for (const double y : {-1.12, 1.12}) m.wheel(p.at(x, y, 0.48), 0.48, 0.3, Material::kTyre);
  }
  m.box(p.at(5.6, 0, 2.65), 0.35, 1.6, 0.28, Material::kScreen);  // destination
}

void truck(Mesh& m, const Placement& p) {
  m.frustum(p.at(2.8, 0, 0.45), 1.9, 2.3, 1.7, 2.2, -0.1, 2.0, Material::kTruckPaint);
  m.quad(p * Eigen::Vector3d(3.76, -1.0, 1.3), p * Eigen::Vector3d(3.76, 1.0, 1.3), p * Eigen::Vector3d(3.63, 1.0, 2.2),
         p * Eigen::Vector3d(3.63, -1.0, 2.2), Material::kVehicleGlass);
  m.box(p.at(-0.95, 0, 0.6), 5.4, 2.0, 0.3, Material::kTruckPaint);
  m.box(p.at(-0.95, 0, 0.9), 5.4, 2.4, 2.4, Material::kTarpaulin);
  for (const double x : {-2.4, 2.6}) {
    for (const double y : {-1.0, 1.0}) m.wheel(p.at(x, y, 0.46), 0.46, 0.28, Material::kTyre);
  }
  m.box(p.at(-3.67, 0, 0.6), 0.04, 1.6, 0.12, Material::kRetroreflector);
}

void tram(Mesh& m, const Placement& p) {
  for (const double end : {1.0, -1.0}) {
    const Placement half = p.at(end * 5.6, 0, 0, end > 0 ? 0.0 : kPi);
    m.frustum(half.at(0, 0, 0.35), 10.6, 2.4, 10.4, 2.3, -0.1, 2.75, Material::kTramPaint);
    windows(m, half.at(-0.2, 0), 9.6, 1.212, 1.35, 2.55, 6, Material::kTramGlass);
    m.quad(half * Eigen::Vector3d(5.32, -1.0, 1.2), half * Eigen::Vector3d(5.32, 1.0, 1.2),
           half * Eigen::Vector3d(5.18, 1.0, 2.6), half * Eigen::Vector3d(5.18, -1.0, 2.6), Material::kTramGlass);
    for (const double x : {-2.8, 2.8}) m.box(half.at(x, 0, 0.02), 2.2, 2.0, 0.33, Material::kTramPaint);
    m.box(half.at(0, 0, 3.1), 4.0, 1.4, 0.3, Material::kTramPaint);
  }
  m.box(p.at(0, 0, 0.5), 0.8, 2.0, 2.4, Material::kTramPaint);  // bellows
}

void bicycle(Mesh& m, const Placement& p) {
  constexpr double kRadius = 0.34;
  rim(m, p, -0.52, kRadius, Material::kBicycle);
  rim(m, p, 0.52, kRadius, Material::kBicycle);
  bar(m, p, {-0.52, 0.35}, {-0.05, 0.3}, 0.03, Material::kBicycle);
  bar(m, p, {-0.05, 0.3}, {0.38, 0.72}, 0.045, Material::kBicycle);
  bar(m, p, {-0.17, 0.72}, {0.38, 0.74}, 0.04, Material::kBicycle);
  bar(m, p, {-0.05, 0.3}, {-0.22, 0.88}, 0.04, Material::kBicycle);
  bar(m, p, {-0.52, 0.35}, {-0.17, 0.72}, 0.025, Material::kBicycle);
  bar(m, p, {0.52, 0.35}, {0.34, 1.0}, 0.035, Material::kBicycle);
  m.box(p.at(-0.24, 0, 0.88), 0.26, 0.14, 0.06, Material::kBicycle);
  m.box(p.at(0.33, 0, 1.0), 0.05, 0.56, 0.03, Material::kBicycle);
}

void motorcycle(Mesh& m, const Placement& p) {
  for (const double x : {-0.68, 0.68}) m.wheel(p.at(x, 0, 0.31), 0.31, 0.14, Material::kMotorcycle);
  m.frustum(p.at(0, 0, 0.3), 0.75, 0.3, 0.55, 0.34, 0.05, 0.35, Material::kMotorcycle);
  m.frustum(p.at(0.12, 0, 0.65), 0.5, 0.3, 0.34, 0.24, 0, 0.25, Material::kMotorcycle);
  m.box(p.at(-0.42, 0, 0.68), 0.62, 0.26, 0.1, Material::kMotorcycle);
  bar(m, p, {0.68, 0.31}, {0.42, 0.98}, 0.09, Material::kMotorcycle);
  m.box(p.at(0.42, 0, 0.96), 0.05, 0.72, 0.04, Material::kMotorcycle);
  m.box(p.at(0.52, 0, 0.72), 0.14, 0.22, 0.2, Material::kMotorcycle);
}

}  // namespace cairn::simulator::scenes
