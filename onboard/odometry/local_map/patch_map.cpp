// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch_map.hpp"

#include <algorithm>

#include "onboard/odometry/local_map/voxel_key.hpp"

namespace cairn::odometry {
namespace {

// In edges. Rings of a VLP-16 are 2° = 0.035 rad apart (data sheet), so at this range they are 1.4
// edges apart: too few of them cross a block.
constexpr float kRange_edges = 40.0F;
constexpr float kUnlimited = 1e9F;  // m, for the coarsest blocks
// A plane that predicts a distance to twice the noise floor is good enough: the finer levels are
// not asked.
constexpr float kGoodSigmas = 2.0F;
// Memory. A grid that is fuller than nine tenths gives up what is farthest, in steps of a tenth of
// the radius.
constexpr std::size_t kFullTenths = 9;
constexpr double kRadiusStep = 0.9;
// Times lasting_s. In a younger map hardly anything can have been seen so long.
constexpr float kYoungMap = 2.0F;

/// Coordinates in halves of the finest block; every grid's index follows from them by shifts.
BlockIndex halves(const Eigen::Vector3d& p, double per_metre) {
  return {floor_to_int(p.x() * per_metre), floor_to_int(p.y() * per_metre), floor_to_int(p.z() * per_metre)};
}

BlockIndex block_of(const BlockIndex& h, int level, int staggered) {
  return {((h.x >> level) + staggered) >> 1, ((h.y >> level) + staggered) >> 1, ((h.z >> level) + staggered) >> 1};
}

/// Lower is better: planes by how well they predict the point, then poles.
PatchMatch match_patch(const Patch& patch, const Eigen::Vector3f& d, float gate) {
  PatchMatch m;
  const float lever = d.squaredNorm();
  const auto row = [&](const Patch::Axis& axis) {
    return PatchMatch::Row{.direction = axis.direction,
                           .distance = axis.direction.dot(d),
                           .variance = patch.prediction_variance(axis, lever)};
  };
  m.row[0] = row(patch.normal);
  m.rows = 1;
  m.epoch = patch.epoch;
  m.lasting = patch.lasting;
  float distance = std::abs(m.row[0].distance);
  if (patch.kind == Patch::Kind::kPole) {
    m.row[1] = row(patch.second);
    m.rows = 2;
    distance = std::hypot(distance, m.row[1].distance);
  }
  m.kind = distance > gate ? PatchMatch::Kind::kOff : PatchMatch::Kind::kOn;
  return m;
}

bool better(const PatchMatch& a, const PatchMatch& b) {
  if (a.kind != b.kind) return a.kind > b.kind;
  if (a.rows != b.rows) return a.rows < b.rows;
  return a.row[0].variance < b.row[0].variance;
}

}  // namespace

PatchMap::PatchMap(const Config& config)
    : halves_per_metre_(2.0 / config.finest_block_m), lasting_s_(config.lasting_s), criteria_(config.criteria) {
  for (int level = 0; level < kLevels; ++level)
    for (const bool staggered : {false, true})
      grids_.emplace_back(static_cast<float>(config.finest_block_m * (1 << level)), staggered,
                          PatchGrid::Limits{static_cast<std::size_t>(config.max_blocks) >> (level > 0 ? 1 : 0),
                                            static_cast<float>(config.max_points_per_block), config.lasting_s});
}

void PatchMap::insert(std::span<const Eigen::Vector3d> points, const PatchGrid::Sensor& sensor, float epoch,
                      Workers& workers) {
  now_s_ = sensor.time_s;
  workers.for_each(grids_.size(), [&](std::size_t g) {
    const int level = static_cast<int>(g / 2), staggered = static_cast<int>(g % 2);
    const float reach = level == kLevels - 1 ? kUnlimited : kRange_edges * static_cast<float>(grids_[g].edge());
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3f to_sensor = (sensor.position - p).cast<float>();
      if (to_sensor.squaredNorm() < reach * reach)
        grids_[g].add(block_of(halves(p, halves_per_metre_), level, staggered), p, to_sensor, {epoch, sensor.time_s});
    }
    grids_[g].refit(criteria_, sensor);
  });
}

PatchMatch PatchMap::match(const Eigen::Vector3d& p, const Eigen::Vector3f& to_sensor, float gate) const {
  const BlockIndex h = halves(p, halves_per_metre_);
  const float good = kGoodSigmas * kGoodSigmas * criteria_.noise_floor_m * criteria_.noise_floor_m;
  const bool young = now_s_ < kYoungMap * lasting_s_;
  PatchMatch best;
  for (int level = kLevels - 1; level >= 0; --level) {
    for (const int staggered : {0, 1}) {
      const PatchGrid& grid = grids_[static_cast<std::size_t>(2 * level + staggered)];
      const BlockIndex at = block_of(h, level, staggered);
      const Patch* patch = grid.find(at, to_sensor);
      if (patch == nullptr) continue;
      PatchMatch m = match_patch(*patch, (p - grid.centre(at)).cast<float>() - patch->centroid, gate);
      m.lasting = m.lasting || young;
      if (better(m, best)) best = m;
    }
    if (best.kind == PatchMatch::Kind::kOn && best.rows == 1 && best.row[0].variance < good) break;
  }
  return best;
}

void PatchMap::keep_within(const Eigen::Vector3d& centre, double radius) {
  for (PatchGrid& grid : grids_) {
    grid.keep_within(centre, radius);
    for (double r = radius; 10 * grid.size() > kFullTenths * grid.capacity(); r *= kRadiusStep)
      grid.keep_within(centre, r);
  }
}

void PatchMap::clear() {
  for (PatchGrid& grid : grids_) grid.clear();
  now_s_ = 0;
}

std::size_t PatchMap::patches() const {
  std::size_t n = 0;
  for (const PatchGrid& grid : grids_) n += grid.patches();
  return n;
}

std::size_t PatchMap::blocks() const {
  std::size_t n = 0;
  for (const PatchGrid& grid : grids_) n += grid.size();
  return n;
}

}  // namespace cairn::odometry
