// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/crowd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/simulator/people/walk.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kBuildStream = 40;

Build draw_build(std::uint64_t seed, std::size_t person) {
  constexpr std::array kTops{Material::kClothesBlue, Material::kClothesRed, Material::kClothesLight,
                             Material::kClothesDark};
  constexpr std::array kTrousers{Material::kClothesDark, Material::kClothesBlue, Material::kClothesLight};
  Random random(seed, kBuildStream, person);
  Build build;
  build.height = random.uniform(1.55, 1.92);
  build.top = kTops[random.below(kTops.size())];
  build.trousers = kTrousers[random.below(kTrousers.size())];
  build.long_sleeves = random.uniform() < 0.6;
  return build;
}

std::vector<Eigen::Vector2d> places(const std::vector<Walker>& walkers) {
  std::vector<Eigen::Vector2d> all;
  all.reserve(walkers.size());
  for (const Walker& w : walkers) all.push_back(w.stride().position);
  return all;
}

}  // namespace

Crowd::Crowd(const World& world, const FloorPlan& plan, std::span<const Trajectory> robots, const CrowdConfig& config,
             std::uint64_t seed)
    : start_(robots.front().start()) {
  std::vector<Walker> walkers;
  for (std::size_t i = 0; i < static_cast<std::size_t>(config.count); ++i) {
    people_.push_back({draw_build(seed, i), {}, {}});
    walkers.emplace_back(plan, robots, i, people_[i].build.height, from_seconds(config.pause_s), seed);
  }
  for (Time t = start_; t <= robots.front().end(); t += kStep) {
    const auto now = places(walkers);
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      people_[i].track.push_back(walkers[i].stride());
      people_[i].ground.push_back(static_cast<float>(world.ground(now[i].x(), now[i].y())));
      walkers[i].step(t, to_seconds(kStep), now, i);
    }
  }
}

Stride Crowd::stride(std::size_t person, Time t) const {
  const std::vector<Stride>& track = people_[person].track;
  const double at = std::max(0.0, to_seconds(t - start_) / to_seconds(kStep));
  const auto i = std::min(static_cast<std::size_t>(at), track.size() - 1);
  if (i + 1 == track.size()) return track[i];
  const double u = at - static_cast<double>(i);
  const auto between = [u](const auto& a, const auto& b) { return (1 - u) * a + u * b; };
  return {between(track[i].position, track[i + 1].position), between(track[i].velocity, track[i + 1].velocity),
          between(track[i].heading, track[i + 1].heading), between(track[i].phase, track[i + 1].phase)};
}

Figure Crowd::figure(std::size_t person, Time t) const {
  const Stride s = stride(person, t);
  const std::vector<float>& ground = people_[person].ground;
  const double at = std::clamp(to_seconds(t - start_) / to_seconds(kStep), 0.0, static_cast<double>(ground.size() - 1));
  const auto i = static_cast<std::size_t>(at);
  const auto j = std::min(i + 1, ground.size() - 1);
  const double u = at - static_cast<double>(i);
  const double height = (1 - u) * static_cast<double>(ground[i]) + u * static_cast<double>(ground[j]);
  Figure figure =
      pose(people_[person].build, {s.position.x(), s.position.y(), height, s.heading}, s.phase, s.velocity.norm());
  figure.person = static_cast<int>(person);
  return figure;
}

std::vector<Figure> Crowd::figures(Time t) const {
  std::vector<Figure> all;
  all.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) all.push_back(figure(i, t));
  return all;
}

std::optional<Hit> Crowd::trace(const Ray& ray, Time t, double max_distance) const {
  constexpr double kColumn = 1.0;  // m, wider than anybody's reach sideways
  const double flat = ray.direction.head<2>().squaredNorm();
  std::optional<Hit> nearest;
  for (std::size_t i = 0; i < size(); ++i) {
    // Seen from above first: most rays pass far from most people, and posing somebody is dear.
    const Eigen::Vector2d to = stride(i, t).position - ray.origin.head<2>();
    const double along = to.dot(ray.direction.head<2>());
    if (along < -kColumn || to.squaredNorm() * flat - along * along > kColumn * kColumn * flat) continue;
    const Figure figure = this->figure(i, t);
    const auto hit = simulator::trace(std::span(&figure, 1), ray, nearest ? nearest->distance : max_distance);
    if (hit) nearest = Hit{hit->distance, std::abs(hit->normal.dot(ray.direction)), hit->part->material};
  }
  return nearest;
}

std::string Crowd::to_csv() const {
  constexpr std::size_t kEvery = 5;
  std::string text = "t,id,x,y,vx,vy\n";
  const std::size_t steps = people_.empty() ? 0 : people_.front().track.size();
  for (std::size_t k = 0; k < steps; k += kEvery) {
    const auto ns = (start_ + kStep * static_cast<std::int64_t>(k)).time_since_epoch().count();
    for (std::size_t i = 0; i < size(); ++i) {
      const Stride& s = people_[i].track[k];
      char line[160];
      std::snprintf(line, sizeof line, "%lld.%09lld,%zu,%.4f,%.4f,%.4f,%.4f\n",
                    static_cast<long long>(ns / 1'000'000'000), static_cast<long long>(ns % 1'000'000'000), i,
                    s.position.x(), s.position.y(), s.velocity.x(), s.velocity.y());
      text += line;
    }
  }
  return text;
}

}  // namespace cairn::simulator
