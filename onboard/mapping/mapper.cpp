// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/mapper.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <utility>

#include "onboard/mapping/tree/key_at.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::mapping {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20U;
// Tiles. Lists of changed tiles have room for so many from the start, and grow beyond it.
constexpr std::size_t kTiles = std::size_t{1} << 14U;

std::size_t megabytes(int n) { return static_cast<std::size_t>(n) * kMegabyte; }

}  // namespace

Mapper::Mapper(const MappingConfig& config, Workers& workers)
    : config_(config),
      workers_(workers),
      tree_(std::make_unique<SemanticOcTree>(config.resolution_m)),
      rays_(config.resolution_m, config.max_range_m),
      footprints_(workers.threads(), Footprint(megabytes(config.max_scan_mb) / sizeof(BrickBits) / 2)),
      labels_(config.label_trust) {
  set_up();
  tree_->reserve_bytes(megabytes(config_.reserve_mb));
}

Mapper::Mapper(const MappingConfig& config, Workers& workers, const SemanticOcTree& saved)
    : config_(config),
      workers_(workers),
      tree_(std::make_unique<SemanticOcTree>(saved)),
      rays_(config.resolution_m, config.max_range_m),
      footprints_(workers.threads(), Footprint(megabytes(config.max_scan_mb) / sizeof(BrickBits) / 2)),
      labels_(config.label_trust) {
  if (saved.getResolution() != config.resolution_m) std::abort();
  set_up();
  tree_->reserve_bytes(megabytes(config_.reserve_mb));
}

void Mapper::set_up() {
  tree_->setProbHit(config_.prob_hit);
  tree_->setProbMiss(config_.prob_miss);
  tree_->setClampingThresMin(config_.clamping_min);
  tree_->setClampingThresMax(config_.clamping_max);
  for (std::vector<TileKey>* tiles : {&changed_, &changed_now_, &merged_}) tiles->reserve(kTiles);
}

std::unique_ptr<SemanticOcTree> Mapper::begin_anew() {
  auto before = std::make_unique<SemanticOcTree>(config_.resolution_m);
  // The first scan of a run begins a map, too: what was reserved stays. A later map gets no reserve of its own, because
  // touching it would hold up the mapping task.
  if (tree_->size() > 0) std::swap(tree_, before);
  set_up();
  changed_.clear();
  entered_.forget();
  return before;
}

Result<InsertReport> Mapper::insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map) {
  if (const auto fit = room(); !fit) return fit.error();
  const auto counts = rays_.prepare(points_map, origin_map, footprints_.front());
  if (!counts) return counts.error();
  if (!march())
    return Error{Errc::kLimit, "the scan touches too much space", {}, {}, "limit the range or use coarser voxels"};
  changed_now_.clear();
  applier_.apply(footprints_.front(), *tree_, workers_, changed_now_);
  note_changed();
  return InsertReport{.points = points_map.size(),
                      .not_finite = counts->not_finite,
                      .outside_map = counts->outside_map,
                      .rays = rays_.ray_count(),
                      .changed_tiles = changed_now_.size()};
}

Result<InsertReport> Mapper::insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map,
                                    const SensorTrust& trust) {
  const SensorModel usual = tree_->sensor_model();
  tree_->setProbHit(trust.prob_hit);
  tree_->setProbMiss(trust.prob_miss);
  rays_.set_max_range(trust.max_range_m);
  spares_ = false;
  auto inserted = insert(points_map, origin_map);
  spares_ = true;
  rays_.set_max_range(config_.max_range_m);
  tree_->set_sensor_model(usual);
  return inserted;
}

Result<InsertReport> Mapper::insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map,
                                    const HeightBand& band) {
  auto inserted = insert(points_map, origin_map);
  if (!inserted || !config_.clear_movers) return inserted;
  entered_.follow(applier_.entered(), footprints_.front(), *tree_, band);
  changed_now_.clear();
  inserted->cleared = entered_.clear(*tree_, changed_now_);
  note_changed();
  return inserted;
}

LabelReport Mapper::label(std::span<const LabelledPoint> points) {
  changed_now_.clear();
  const LabelReport report = labels_.update(points, *tree_, changed_now_);
  note_changed();
  return report;
}

std::size_t Mapper::take_back(std::span<const Eigen::Vector3f> points_map) {
  changed_now_.clear();
  const std::size_t voxels = retraction_.take_back(points_map, *tree_, changed_now_);
  note_changed();
  return voxels;
}

Result<void> Mapper::room() const {
  if (tree_->memoryUsage() > std::max(megabytes(config_.max_mb), megabytes(config_.reserve_mb) + kMegabyte))
    return Error{Errc::kLimit, "the map is as large as allowed", {}, {}, std::to_string(config_.max_mb) + " MB"};
  return {};
}

Result<void> Mapper::fill(std::span<const TileKey> tiles, const SemanticOcTree& other) {
  if (auto fit = room(); !fit) return fit;
  changed_now_.clear();
  for (const TileKey tile : tiles)
    if (fill_tile(*tree_, tile, other)) changed_now_.push_back(tile);
  note_changed();
  return {};
}

Standing Mapper::standing(const Eigen::Vector3f& p) const {
  const auto key = key_at(*tree_, p.cast<double>());
  const SemanticNode* node = key ? tree_->search(*key) : nullptr;
  if (node == nullptr) return Standing::kUnknown;
  const SensorModel model = tree_->sensor_model();
  const float known = node->getLogOdds() - model.occupied;
  if (known > 2 * model.hit) return Standing::kSettled;
  if (known >= 0) return Standing::kOccupied;
  return known <= kFreeRays * model.miss ? Standing::kFree : Standing::kUnknown;
}

/// A set does not depend on how its parts were found: here the number of parts may depend on the
/// number of threads.
bool Mapper::march() {
  Footprint& whole = footprints_.front();
  const SemanticOcTree* surfaces = config_.spare_surfaces && spares_ ? tree_.get() : nullptr;
  const std::size_t parts = footprints_.size();
  for (std::size_t i = 1; i < parts; ++i) footprints_[i].reset(whole.grid());
  const MarchRays march_rays = best_march(whole);
  workers_.for_each(parts, [&](std::size_t i) {
    const std::size_t rays = rays_.ray_count();
    rays_.march(rays * i / parts, rays * (i + 1) / parts, march_rays, footprints_[i], surfaces);
  });
  for (std::size_t i = 1; i < parts; ++i) whole.merge(footprints_[i]);
  return !whole.overflown();
}

void Mapper::note_changed() {
  merged_.clear();
  std::set_union(changed_.begin(), changed_.end(), changed_now_.begin(), changed_now_.end(),
                 std::back_inserter(merged_));
  std::swap(changed_, merged_);
}

std::vector<TileKey> Mapper::take_changed_tiles() {
  std::vector<TileKey> taken = changed_;  // a copy, so that inserting goes on without allocating
  changed_.clear();
  return taken;
}

}  // namespace cairn::mapping
