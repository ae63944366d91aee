// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/merge.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "fusion/merging/remembered_fold.hpp"
#include "fusion/merging/resampling.hpp"

namespace cairn::merging {
namespace {

constexpr int kEdge = 1 << mapping::SemanticOcTree::kDepth;
constexpr std::int64_t kNodesOfTile = 64;  // what looking into a tile counts for, and its voxels on top of it

Limits limits_of(const mapping::SemanticOcTree& map) {
  const mapping::SensorModel model = map.sensor_model();
  return {model.min, model.max, model.occupied};
}

/// Builds the fused tree from the root down, and stops dividing where nobody's map divides.
class Fusion {
 public:
  Fusion(const Contributions& contributions, const MergeOptions& options, mapping::SemanticOcTree& fused)
      : fused_(fused), fold_(options.policy, limits_of(fused)) {
    std::int64_t came_in = 0;
    for (const auto& [robot, contribution] : contributions)
      came_in += static_cast<std::int64_t>(contribution.map->size());
    max_nodes_ = std::min(options.max_nodes, kSpareNodes + kNodesPerNode * came_in);
    for (const auto& [robot, contribution] : contributions) {
      views_.emplace_back(*contribution.map, contribution.T_fused_map, fused.getResolution());
    }
    contents_.resize(views_.size());
    tiles_.resize(views_.size());
    places_.resize(mapping::SemanticOcTree::kDepth + 2, {});
    for (const Resampled& view : views_) places_[0].push_back(view.root());
  }

  /// False when the map grew beyond its limit.
  bool run() {
    bool made = false;
    mapping::SemanticNode* root = fused_.root_or_new(made);
    const bool known = fuse(Eigen::Vector3i::Zero(), kEdge, 0, root);
    fused_.settle_count();
    if (!known) fused_.clear();
    return nodes_ < max_nodes_;
  }

 private:
  /// Fills in the node of one cube; false when nobody knows anything of it, and the node is to be taken back.
  // NOLINTNEXTLINE(misc-no-recursion)
  bool fuse(const Eigen::Vector3i& first, int edge, std::size_t depth, mapping::SemanticNode* node) {
    if (++nodes_ >= max_nodes_) return false;
    bool mixed = false;
    opinions_.clear();
    places_[depth + 1] = places_[depth];
    for (std::size_t i = 0; i < views_.size(); ++i) {
      contents_[i] = views_[i].look(first, edge, places_[depth + 1][i]);
      mixed = mixed || contents_[i].kind == Content::Kind::kMixed;
      if (contents_[i].kind == Content::Kind::kUniform) opinions_.push_back(contents_[i].log_odds);
    }
    if (mixed) return edge == mapping::kTileEdge ? fuse_tile(first, depth, node) : divide(first, edge, depth, node);
    if (opinions_.empty()) return false;
    node->setLogOdds(fold_(opinions_));
    return true;
  }

  /// The last three levels at once, of a cube that somebody's map divides.
  bool fuse_tile(const Eigen::Vector3i& first, std::size_t depth, mapping::SemanticNode* node) {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (contents_[i].kind == Content::Kind::kMixed)
        views_[i].read(first, places_[depth + 1][i], tiles_[i]);
      else
        tiles_[i].fill(contents_[i].kind == Content::Kind::kUniform ? contents_[i].log_odds
                                                                    : mapping::SemanticNode::kAbsent);
    }
    for (std::size_t k = 0; k < mapping::kTileVoxels; ++k) fused_tile_[k] = fused_voxel(k);
    const std::int64_t known =
        mapping::kTileVoxels - std::count(fused_tile_.begin(), fused_tile_.end(), mapping::SemanticNode::kAbsent);
    nodes_ += kNodesOfTile + known;
    return nodes_ < max_nodes_ && mapping::write_voxels(fused_tile_, fused_.writer(0), node);
  }

  /// Of voxel `k` of the tiles at hand. One opinion stays what it is, under any policy.
  float fused_voxel(std::size_t k) {
    float only = mapping::SemanticNode::kAbsent;
    int known = 0;
    for (const mapping::TileVoxels& tile : tiles_) {
      const bool here = tile[k] != mapping::SemanticNode::kAbsent;
      only = here ? tile[k] : only;
      known += here ? 1 : 0;
    }
    if (known <= 1) return only;
    opinions_.clear();
    for (const mapping::TileVoxels& tile : tiles_)
      if (tile[k] != mapping::SemanticNode::kAbsent) opinions_.push_back(tile[k]);
    return fold_(opinions_);
  }

  // NOLINTNEXTLINE(misc-no-recursion)
  bool divide(const Eigen::Vector3i& first, int edge, std::size_t depth, mapping::SemanticNode* node) {
    mapping::NodeWriter& writer = fused_.writer(0);
    bool any = false, made = false;
    for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i) {
      const auto bit = [&](unsigned axis) { return static_cast<int>(i >> axis & 1U); };
      mapping::SemanticNode* child = writer.child(node, i, made);
      if (fuse(first + edge / 2 * Eigen::Vector3i(bit(0), bit(1), bit(2)), edge / 2, depth + 1, child)) {
        any = true;
        continue;
      }
      child->setLogOdds(mapping::SemanticNode::kAbsent);
      writer.count(-1);
    }
    if (any)
      writer.refresh(node);
    else
      writer.drop_block(node);
    return any;
  }

  mapping::SemanticOcTree& fused_;
  RememberedFold fold_;
  std::vector<Resampled> views_;
  std::vector<std::vector<Resampled::Place>> places_;  // by depth
  std::vector<Content> contents_;                      // by view, of the cube at hand
  std::vector<mapping::TileVoxels> tiles_;             // by view
  mapping::TileVoxels fused_tile_;
  std::vector<float> opinions_;  // about the cube at hand
  std::int64_t nodes_ = 0, max_nodes_ = 0;
};

Result<void> check(const Contributions& contributions) {
  if (contributions.empty()) return Error{Errc::kInvalidConfig, "nothing to merge"};
  for (const auto& [robot, contribution] : contributions) {
    const std::string name = "robot " + std::to_string(robot);
    if (contribution.map == nullptr) return Error{Errc::kInvalidConfig, "a contribution has no map", name};
    if (!contribution.T_fused_map.matrix().allFinite())
      return Error{Errc::kInvalidConfig, "the pose of a map is not finite", name};
  }
  return {};
}

}  // namespace

bool offer(Contributions& contributions, std::uint64_t robot, Contribution contribution) {
  const auto held = contributions.find(robot);
  if (held != contributions.end() && held->second.version >= contribution.version) return false;
  contributions.insert_or_assign(robot, std::move(contribution));
  return true;
}

Result<std::unique_ptr<mapping::SemanticOcTree>> merge(const Contributions& contributions,
                                                       const MergeOptions& options) {
  if (const auto fit = check(contributions); !fit) return fit.error();
  double resolution = contributions.begin()->second.map->getResolution();
  for (const auto& [robot, contribution] : contributions)
    resolution = std::min(resolution, contribution.map->getResolution());
  auto fused = std::make_unique<mapping::SemanticOcTree>(resolution);
  fused->set_sensor_model(contributions.begin()->second.map->sensor_model());
  if (!Fusion(contributions, options, *fused).run())
    return Error{Errc::kLimit, "the fused map would be too large for what came in"};
  return fused;
}

}  // namespace cairn::merging
