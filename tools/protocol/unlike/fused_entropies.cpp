// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/fused_entropies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "fusion/merging/labels.hpp"
#include "fusion/merging/team_map.hpp"
#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "tools/protocol/pairs/merged_pair.hpp"

namespace cairn::protocol {
namespace {

using mapping::SemanticNode;
using mapping::SemanticOcTree;
using merging::ClassProbabilities;

constexpr std::size_t kMostTiles = 1'000'000;  // of a map: a bound on time

class EntropySum {
 public:
  void add(double occupancy, const std::optional<ClassProbabilities>& label) {
    ++sum_.occupied;
    sum_.occupancy += report::binary_entropy(occupancy);
    sum_.book += report::book_entropy(occupancy);
    if (!label) return;
    ++sum_.labelled;
    sum_.label += merging::label_entropy(*label);
  }
  [[nodiscard]] Entropies mean() const {
    Entropies e = sum_;
    const double occupied = std::max(1.0, static_cast<double>(e.occupied));
    e.occupancy /= occupied;
    e.book /= occupied;
    e.label /= std::max(1.0, static_cast<double>(e.labelled));
    return e;
  }

 private:
  Entropies sum_;
};

struct Sums {
  EntropySum a, b, fused;
  [[nodiscard]] EntropiesOfThree mean() const { return {a.mean(), b.mean(), fused.mean()}; }
};

/// What a map knows of a point: the leaf if it is occupied.
const SemanticNode* occupied_at(const SemanticOcTree& map, const Eigen::Vector3d& p) {
  const SemanticNode* node = map.search(p.x(), p.y(), p.z());
  return node != nullptr && map.isNodeOccupied(node) ? node : nullptr;
}

/// All 19 probabilities, where there is a label.
std::optional<ClassProbabilities> label_of(const SemanticNode* node) {
  if (node == nullptr) return std::nullopt;
  const auto evidence = mapping::LabelEvidence::from_id(node->label_id());
  return evidence.any() ? std::optional(evidence.probabilities()) : std::nullopt;
}

std::optional<ClassProbabilities> fused_label(const std::optional<ClassProbabilities>& a,
                                              const std::optional<ClassProbabilities>& b) {
  std::vector<ClassProbabilities> opinions;
  if (a) opinions.push_back(*a);
  if (b) opinions.push_back(*b);
  return opinions.empty() ? std::nullopt : std::optional(merging::fuse_labels(opinions));
}

Entropies entropies_of(const SemanticOcTree& map) {
  EntropySum sum;
  mapping::for_each_occupied_voxel(
      map, [&](const Eigen::Vector3f&, const SemanticNode& leaf) { sum.add(leaf.getOccupancy(), label_of(&leaf)); });
  return sum.mean();
}

/// A voxel of the fused map takes from each robot the voxel that its centre falls into, as merging does.
void add_by_the_books_rules(const MapPair& pair, const SE3& T_a_b, const SemanticOcTree& fused,
                            FusedEntropies& entropies) {
  EntropySum whole;
  Sums shared;
  const SE3 T_b_a = T_a_b.inverse();
  mapping::for_each_occupied_voxel(fused, [&](const Eigen::Vector3f& centre, const SemanticNode& leaf) {
    const Eigen::Vector3d p = centre.cast<double>();
    const SemanticNode *of_a = occupied_at(*pair.a, p), *of_b = occupied_at(*pair.b, T_b_a * p);
    const auto label_a = label_of(of_a), label_b = label_of(of_b), label = fused_label(label_a, label_b);
    whole.add(leaf.getOccupancy(), label);
    if (of_a == nullptr || of_b == nullptr) return;
    const bool both = label_a && label_b;  // a label of one robot alone would be fused with nothing
    shared.a.add(of_a->getOccupancy(), both ? label_a : std::nullopt);
    shared.b.add(of_b->getOccupancy(), both ? label_b : std::nullopt);
    shared.fused.add(leaf.getOccupancy(), both ? label : std::nullopt);
  });
  entropies.whole = {entropies_of(*pair.a), entropies_of(*pair.b), whole.mean()};
  entropies.shared = shared.mean();
}

/// A team's map of some of the pair's maps, by robots' numbers: 1 is a, 2 is b.
std::unique_ptr<SemanticOcTree> team_map(const MapPair& pair, const SE3& T_a_b, std::vector<std::uint64_t> robots) {
  merging::TeamMap team(pair.a->getResolution(), merging::Policy::kRelativeEntropy);
  merging::SubmapPoses poses;
  for (const std::uint64_t robot : robots) {
    const SemanticOcTree& map = robot == 1 ? *pair.a : *pair.b;
    for (const mapping::TileKey tile : mapping::known_tiles(map, kMostTiles))
      team.put({robot, 0}, tile, mapping::read_tile(map, tile), Time{});
    poses[{robot, 0}] = robot == 1 ? SE3() : T_a_b;
  }
  team.place(poses);
  Budget all = Budget::steps(std::numeric_limits<int>::max());
  (void)team.fuse(all);
  return std::make_unique<SemanticOcTree>(team.map());
}

}  // namespace

double Entropies::overall() const {
  const auto n = static_cast<double>(occupied), m = static_cast<double>(labelled);
  return (n * occupancy + m * label) / std::max(1.0, n + m);
}

Result<FusedPair> fuse_pair(const MapPair& pair, const SE3& T_a_b) {
  const double of_a = pair.a->getResolution(), of_b = pair.b->getResolution();
  if (of_a != of_b)
    return Error{
        Errc::kInvalidConfig, "the maps have two resolutions", pair.name, {}, fmt::format("{} and {} m", of_a, of_b)};
  for (const auto& map : {pair.a, pair.b})
    if (const auto listable = mapping::listable_voxels(*map); !listable) return listable.error();
  const auto fused = merged_pair(pair, T_a_b, merging::Policy::kBayes);
  if (!fused) return fused.error();
  if (const auto listable = mapping::listable_voxels(**fused); !listable) return listable.error();
  FusedPair done;
  add_by_the_books_rules(pair, T_a_b, **fused, done.entropies);
  done.told_map = team_map(pair, T_a_b, {1, 2});
  // One robot's in its own frame: turned into another grid, voxels are lost and doubled.
  done.entropies.told = {entropies_of(*team_map(pair, T_a_b, {1})), entropies_of(*team_map(pair, {}, {2})),
                         entropies_of(*done.told_map)};
  return done;
}

}  // namespace cairn::protocol
