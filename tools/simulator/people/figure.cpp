// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/figure.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

constexpr double kThigh = 0.245, kShin = 0.235, kTrunk = 0.30, kUpperArm = 0.17, kForearm = 0.15;  // of the height
constexpr double kFootRadius = 0.05, kHeadRadius = 0.105;                                          // m

std::optional<CapsuleHit> ball(const Ray& ray, const Vector3d& centre, double radius) {
  const Vector3d from = ray.origin - centre;
  const double b = from.dot(ray.direction), c = from.squaredNorm() - radius * radius;
  const double h = b * b - c;
  if (h < 0) return std::nullopt;
  const double distance = -b - std::sqrt(h);
  if (distance < 0) return std::nullopt;
  return CapsuleHit{distance, (from + distance * ray.direction) / radius};
}

/// A direction in the plane of walking: 0 points down, positive angles forward.
Vector3d swung(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

struct Leg {
  Vector3d knee, ankle;  // from the hip joint
};

/// The knee goes forward and the foot stays in the leg's line: a bent leg is shorter than a straight one.
Leg leg(double height, double swing, double flex) {
  const Vector3d knee = kThigh * height * swung(swing + 0.5 * flex);
  return {knee, knee + kShin * height * swung(swing - 0.5 * flex)};
}

/// Collects parts given in the frame of the person's stand.
class Sculptor {
 public:
  Sculptor(Figure& figure, const Build& build) : figure_(figure), build_(build) {}

  void legs(double hip, const std::array<Leg, 2>& legs) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector3d joint(0, i == 0 ? 0.09 : -0.09, hip);
      const Vector3d ankle = joint + legs[i].ankle;
      part(joint, joint + legs[i].knee, 0.075, build_.trousers);
      part(joint + legs[i].knee, ankle, kFootRadius, build_.trousers);
      part(ankle, ankle + Vector3d(0.15, 0, 0), kFootRadius, Material::kClothesDark);
    }
  }

  void trunk(double hip) {
    const double shoulder = hip + kTrunk * build_.height;
    for (const double side : {-0.08, 0.08}) {
      part({0, side, hip + 0.08}, {0, 1.1 * side, shoulder - 0.06}, 0.115, build_.top);
    }
    part({0, 0, hip}, {0, 0, hip + 0.05}, 0.13, build_.trousers);
    const double head = build_.height - kHeadRadius - 0.01 - (standing_hip() - hip);
    part({0, 0, shoulder}, {0.01, 0, head - 0.06}, 0.055, Material::kSkin);
    part({0.02, 0, head - 0.03}, {0.02, 0, head}, kHeadRadius - 0.01, Material::kSkin);
    part({-0.012, 0, head + 0.01}, {-0.012, 0, head + 0.01}, kHeadRadius, Material::kHair);
  }

  void arms(double hip, double swing) {
    const Material sleeve = build_.long_sleeves ? build_.top : Material::kSkin;
    for (const double side : {1.0, -1.0}) {
      const double angle = -side * swing;
      const Vector3d shoulder(0, side * 0.2, hip + kTrunk * build_.height - 0.02);
      const Vector3d elbow = shoulder + kUpperArm * build_.height * swung(angle);
      const Vector3d hand = elbow + kForearm * build_.height * swung(angle + 0.3);
      part(shoulder, elbow, 0.05, build_.top);
      part(elbow, hand, 0.04, sleeve);
      part(hand, hand + 0.07 * swung(angle + 0.3), 0.042, Material::kSkin);
    }
  }

  [[nodiscard]] double standing_hip() const { return (kThigh + kShin) * build_.height + kFootRadius; }

 private:
  void part(const Vector3d& a, const Vector3d& b, double radius, Material material) {
    figure_.parts[count_++] = {figure_.stand * a, figure_.stand * b, radius, material};
  }

  Figure& figure_;
  const Build& build_;
  std::size_t count_ = 0;
};

}  // namespace

std::optional<CapsuleHit> intersect(const Ray& ray, const Capsule& capsule) {
  const Vector3d axis = capsule.b - capsule.a, from = ray.origin - capsule.a;
  const double axis2 = axis.squaredNorm(), along = axis.dot(ray.direction), start = axis.dot(from);
  const double a = axis2 - along * along;
  if (a <= 1e-12) {  // a ball, or the ray runs along the axis: the nearer end is met first
    const bool from_a = along >= 0;
    return ball(ray, from_a ? capsule.a : capsule.b, capsule.radius);
  }
  const double b = axis2 * from.dot(ray.direction) - start * along;
  const double c = axis2 * (from.squaredNorm() - capsule.radius * capsule.radius) - start * start;
  const double h = b * b - a * c;
  if (h < 0) return std::nullopt;
  const double distance = (-b - std::sqrt(h)) / a, foot = start + distance * along;
  if (foot <= 0) return ball(ray, capsule.a, capsule.radius);
  if (foot >= axis2) return ball(ray, capsule.b, capsule.radius);
  if (distance < 0) return std::nullopt;
  return CapsuleHit{distance, (from + distance * ray.direction - foot / axis2 * axis) / capsule.radius};
}

double step_length(double height, double speed) { return height * (0.22 + 0.14 * speed); }

Figure pose(const Build& build, const Placement& stand, double phase, double speed) {
  Figure figure;
  figure.stand = stand;
  const double lively = std::min(1.0, speed / 0.3);  // somebody who slows down ends with the feet together
  const double reach = std::min(0.8, 0.5 * step_length(build.height, speed) / ((kThigh + kShin) * build.height));
  const double swing = lively * std::asin(reach);
  std::array<Leg, 2> legs;
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = phase + (i == 0 ? 0.0 : 3.14159265358979323846);
    // The knee bends while its leg swings forward.
    legs[i] = leg(build.height, swing * std::sin(at), lively * std::max(0.0, std::cos(at)));
  }
  const double hip = kFootRadius - std::min(legs[0].ankle.z(), legs[1].ankle.z());
  Sculptor sculptor(figure, build);
  sculptor.legs(hip, legs);
  sculptor.trunk(hip);
  sculptor.arms(hip, 0.7 * swing * std::sin(phase));
  figure.centre = stand * Vector3d(0, 0, 0.5 * build.height);
  figure.reach = 0.5 * build.height + 0.3;
  return figure;
}

bool may_hit(const Ray& ray, const Vector3d& centre, double reach) {
  const Vector3d to = centre - ray.origin;
  const double along = to.dot(ray.direction), distance2 = to.squaredNorm();
  return along > -reach && distance2 - along * along <= reach * reach;
}

std::optional<FigureHit> trace(std::span<const Figure> figures, const Ray& ray, double max_distance) {
  std::optional<FigureHit> nearest;
  for (const Figure& figure : figures) {
    if (!may_hit(ray, figure.centre, figure.reach)) continue;
    for (const Capsule& part : figure.parts) {
      const auto hit = intersect(ray, part);
      if (!hit || hit->distance > (nearest ? nearest->distance : max_distance)) continue;
      nearest = FigureHit{hit->distance, hit->normal, &figure, &part};
    }
  }
  return nearest;
}

}  // namespace cairn::simulator
