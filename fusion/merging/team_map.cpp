// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/team_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "fusion/merging/labels.hpp"

namespace cairn::merging {
namespace {

constexpr unsigned kRegionBits = 9;                     // of a tile's key: 8³ tiles are a region
constexpr unsigned kTurns = 2;                          // one of so many steps is for the map that is shown
constexpr int kCatchUps = 4;                            // rounds in which a new map takes in what changed meanwhile
constexpr std::size_t kMarkedAtOnce = 16;               // tiles that one step marks
constexpr std::size_t kChunk = std::size_t{128} << 10;  // bytes: a step that needs a new chunk takes 30 µs longer
constexpr int kTeamTiles = 1 << 13;                     // along an axis of the tree
constexpr float kSteps = 1024;                          // of log-odds, per unit
constexpr Limits kLimits{mapping::TileState::kFree.front(), mapping::TileState::kOccupied.front(), 0};

template <class Visit>
void for_each_tile(const TileBox& box, const Visit& visit) {
  const Eigen::Vector3i low = box.low.cwiseMax(0), high = box.high.cwiseMin(kTeamTiles - 1);
  const auto voxel = [](int tile) { return static_cast<std::uint16_t>(tile * 8); };
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) visit(mapping::TileKey::of_voxel(voxel(x), voxel(y), voxel(z)));
}

}  // namespace

TeamMap::TeamMap(double resolution_m, Policy policy)
    : resolution_m_(resolution_m), shown_(view_of({})), fold_(policy, kLimits) {
  shown_.fused = empty_map();
}

std::unique_ptr<mapping::SemanticOcTree> TeamMap::empty_map() {
  if (!spare_) return std::make_unique<mapping::SemanticOcTree>(resolution_m_, kChunk);
  spare_->begin_anew();
  return std::exchange(spare_, nullptr);
}

TeamMap::View TeamMap::view_of(const SubmapPoses& poses) const {
  View view;
  view.poses = poses;
  for (const auto& [submap, T_team_submap] : poses)
    if (const auto placement = Placement::of(T_team_submap, resolution_m_)) view.placements.emplace(submap, *placement);
  if (!view.placements.empty()) view.marking = view.placements.begin()->first;
  return view;
}

void TeamMap::put(const SubmapKey& submap, mapping::TileKey tile, const mapping::TileState& state, Time stamp) {
  TileLayer& layer = layers_[submap];
  if (state.empty())
    layer.erase(tile);
  else
    layer.insert_or_assign(tile, ReceivedTile{state, stamp});
  const auto mark_in = [&](const View& view, Dirty& dirty) {
    const auto placement = view.placements.find(submap);
    if (placement != view.placements.end()) mark(dirty, placement->second, tile);
  };
  mark_in(shown_, shown_.dirty);
  if (next_) mark_in(*next_, next_->later);
}

void TeamMap::drop(std::uint64_t robot) {
  const auto dropped = std::erase_if(layers_, [robot](const auto& layer) { return layer.first.robot == robot; });
  redo_ = redo_ || dropped > 0;
  begin_wanted();
}

void TeamMap::place(const SubmapPoses& T_team_submaps) {
  const auto same = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.matrix() == b.second.matrix();
  };
  if (std::ranges::equal(wanted_, T_team_submaps, same)) return;
  wanted_ = T_team_submaps;
  begin_wanted();
}

/// A map that is being built is finished first: poses may change faster than maps are built.
void TeamMap::begin_wanted() {
  if (next_) return;
  View view = view_of(wanted_);
  if (!redo_ && view.placements == shown_.placements) {
    shown_.poses = wanted_;
    return;
  }
  if (!redo_ && add_to_shown(view)) return;
  redo_ = false;
  view.fused = empty_map();
  next_ = std::move(view);
}

/// A submap that has just begun holds next to nothing: what is shown takes it in where all others stay where they are.
bool TeamMap::add_to_shown(const View& wanted) {
  const auto ahead = [](const auto& x, const auto& y) { return x.first < y.first; };
  std::map<SubmapKey, Placement> added;
  std::ranges::set_difference(wanted.placements, shown_.placements, std::inserter(added, added.end()), ahead);
  std::size_t tiles = 0;
  for (const auto& [submap, placement] : added)
    if (const auto layer = layers_.find(submap); layer != layers_.end()) tiles += layer->second.size();
  const auto stays = [&](const auto& shown) {
    const auto found = wanted.placements.find(shown.first);
    return found != wanted.placements.end() && found->second == shown.second;
  };
  if (tiles > kMarkedAtOnce || shown_.marking || !std::ranges::all_of(shown_.placements, stays)) return false;
  for (const auto& [submap, placement] : added)
    if (const auto layer = layers_.find(submap); layer != layers_.end())
      for (const auto& [tile, received] : layer->second) mark(shown_.dirty, placement, tile);
  shown_.placements = wanted.placements;
  shown_.poses = wanted_;
  return true;
}

void TeamMap::mark(Dirty& dirty, const Placement& placement, mapping::TileKey tile) {
  for_each_tile(placement.touched_by(tile),
                [&](mapping::TileKey touched) { dirty[touched.morton >> kRegionBits].insert(touched); });
}

void TeamMap::mark_some(View& view) const {
  const auto placement = view.placements.find(*view.marking);
  const auto layer = layers_.find(*view.marking);
  if (layer != layers_.end()) {
    auto tile = view.marked ? layer->second.upper_bound(*view.marked) : layer->second.begin();
    for (std::size_t i = 0; i < kMarkedAtOnce && tile != layer->second.end(); ++i, ++tile) {
      mark(view.dirty, placement->second, tile->first);
      view.marked = tile->first;
    }
    if (tile != layer->second.end()) return;
  }
  const auto next = std::next(placement);
  view.marking = next == view.placements.end() ? std::nullopt : std::optional(next->first);
  view.marked.reset();
}

mapping::TileKey TeamMap::take_nearest(View& view) const {
  const auto distance = [&](std::uint64_t region) {
    const mapping::TileKey first{region << kRegionBits};
    Eigen::Vector3d centre;
    for (unsigned axis = 0; axis < 3; ++axis)
      centre[static_cast<Eigen::Index>(axis)] = (first.first_voxel(axis) - 32768 + 32) * resolution_m_;
    return (centre - focus_).squaredNorm();
  };
  if (!view.region || !view.dirty.contains(*view.region)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [region, tiles] : view.dirty)
      if (const double d = distance(region); d < nearest) {
        nearest = d;
        view.region = region;
      }
  }
  auto& tiles = view.dirty.at(*view.region);
  const mapping::TileKey tile = *tiles.begin();
  tiles.erase(tiles.begin());
  if (tiles.empty()) view.dirty.erase(*view.region);
  return tile;
}

void TeamMap::fuse_tile(View& view, mapping::TileKey tile) {
  std::size_t known = 0;
  bool labelled = false;
  for (const auto& [submap, placement] : view.placements) {
    const auto layer = layers_.find(submap);
    if (layer == layers_.end()) continue;
    if (by_submap_.size() <= known) by_submap_.emplace_back();
    if (!placement.read(layer->second, tile, by_submap_[known])) continue;
    labelled = labelled || by_submap_[known].labelled;
    ++known;
  }
  mapping::TileVoxels fused;
  mapping::TileLabels labels;
  for (std::size_t i = 0; i < fused.size(); ++i) {
    opinions_.clear();
    for (std::size_t k = 0; k < known; ++k)
      if (by_submap_[k].voxels[i] != mapping::SemanticNode::kAbsent) opinions_.push_back(by_submap_[k].voxels[i]);
    fused[i] = opinions_.empty() ? mapping::SemanticNode::kAbsent : std::nearbyintf(fold_(opinions_) * kSteps) / kSteps;
    labels[i] = labelled && fused[i] >= kLimits.occupied ? fused_label(known, i) : mapping::VoxelLabel{};
  }
  mapping::write_tile(*view.fused, tile, fused, labelled ? &labels : nullptr);
  if (changed_ && &view == &shown_) changed_->insert(tile);
}

mapping::VoxelLabel TeamMap::fused_label(std::size_t known, std::size_t voxel) {
  labels_.clear();
  for (std::size_t k = 0; k < known; ++k)
    if (by_submap_[k].labelled && by_submap_[k].labels[voxel].any()) labels_.push_back(by_submap_[k].labels[voxel]);
  return labels_.empty() ? mapping::VoxelLabel{} : fuse_labels(labels_);
}

void TeamMap::step(View& view) {
  if (view.marking)
    mark_some(view);
  else
    fuse_tile(view, take_nearest(view));
}

void TeamMap::note_all(const mapping::SemanticOcTree& map) {
  if (!changed_) return;
  const auto tiles = mapping::known_tiles(map, std::numeric_limits<std::size_t>::max());
  changed_->insert(tiles.begin(), tiles.end());
}

std::vector<mapping::TileKey> TeamMap::take_changed_tiles() {
  if (!changed_) return {};
  std::vector<mapping::TileKey> tiles(changed_->begin(), changed_->end());
  changed_->clear();
  return tiles;
}

/// What is shown must not be older than what was; but tiles may change faster than they are caught up with.
void TeamMap::catch_up_or_show() {
  if (!next_->later.empty() && next_->catch_ups++ < kCatchUps)
    next_->dirty = std::exchange(next_->later, {});
  else
    show_next();
}

void TeamMap::show_next() {
  note_all(*shown_.fused);
  note_all(*next_->fused);
  spare_ = std::move(shown_.fused);
  shown_ = std::move(*next_);
  shown_.dirty = std::exchange(shown_.later, {});
  next_.reset();
  begin_wanted();
}

bool TeamMap::fuse(Budget& budget) {
  while (!up_to_date() && budget.one_more()) {
    // What is shown is kept up to date, but must not starve what is to come: tiles may change faster than both can be.
    const bool for_shown = !complete(shown_) && (!next_ || complete(*next_) || ++turn_ % kTurns == 0);
    if (for_shown)
      step(shown_);
    else if (!complete(*next_))
      step(*next_);
    if (next_ && complete(*next_)) catch_up_or_show();
  }
  return up_to_date();
}

bool TeamMap::up_to_date() const { return complete(shown_) && !next_; }

std::size_t TeamMap::backlog() const {
  std::size_t tiles = 0;
  for (const View* view : {&shown_, next_ ? &*next_ : nullptr}) {
    if (view == nullptr) continue;
    for (const auto& [region, dirty] : view->dirty) tiles += dirty.size();
  }
  return tiles;
}

TeamMap::Origin TeamMap::origin_of(mapping::TileKey tile) const {
  Origin origin;
  Placement::Opinion opinion;
  for (const auto& [submap, placement] : shown_.placements) {
    const auto layer = layers_.find(submap);
    if (layer == layers_.end() || !placement.read(layer->second, tile, opinion)) continue;
    if (origin.robots.empty() || origin.robots.back() != submap.robot) origin.robots.push_back(submap.robot);
    for_each_tile(placement.sources_of(tile), [&](mapping::TileKey source) {
      const auto received = layer->second.find(source);
      if (received != layer->second.end()) origin.newest = std::max(origin.newest, received->second.stamp);
    });
  }
  return origin;
}

}  // namespace cairn::merging
