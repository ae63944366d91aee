// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/fused_entropies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "fusion/matching/book/point_grid.hpp"
#include "fusion/merging/labels.hpp"
#include "fusion/merging/team_map.hpp"
#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/report/figures/map_measures.hpp"

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

/// All 19 probabilities, where there is a label.
std::optional<ClassProbabilities> label_of(const SemanticNode& node) {
  const auto evidence = mapping::LabelEvidence::from_id(node.label_id());
  return evidence.any() ? std::optional(evidence.probabilities()) : std::nullopt;
}

Entropies entropies_of(const SemanticOcTree& map) {
  EntropySum sum;
  mapping::for_each_occupied_voxel(
      map, [&](const Eigen::Vector3f&, const SemanticNode& leaf) { sum.add(leaf.getOccupancy(), label_of(leaf)); });
  return sum.mean();
}

/// An occupied voxel.
struct Voxel {
  Eigen::Vector3f centre;
  float log_odds = 0;
  std::optional<ClassProbabilities> label;

  [[nodiscard]] double occupancy() const { return merging::probability(log_odds); }
};

std::vector<Voxel> voxels_of(const SemanticOcTree& map, const SE3& T) {
  std::vector<Voxel> voxels;
  mapping::for_each_occupied_voxel(map, [&](const Eigen::Vector3f& centre, const SemanticNode& leaf) {
    voxels.push_back({(T * centre.cast<double>()).cast<float>(), leaf.getLogOdds(), label_of(leaf)});
  });
  return voxels;
}

/// E-step (7.15): by distance in metres, by difference of the occupancies, and by whether both name a class and not the
/// same one.
float distance(const Voxel& a, const Voxel& b, float squared_m) {
  const auto likeliest = [](const ClassProbabilities& p) { return std::ranges::max_element(p) - p.begin(); };
  const auto apart = static_cast<float>(a.occupancy() - b.occupancy());
  const bool mismatch = a.label && b.label && likeliest(*a.label) != likeliest(*b.label);
  return squared_m + apart * apart + (mismatch ? 1.0F : 0.0F);
}

/// Of each voxel of a, those of b that are nearest to it and within the diagonal of a voxel. `alone`: those of b that
/// have none.
struct Associations {
  std::vector<std::vector<std::size_t>> of_a;
  std::vector<std::size_t> alone;

  Associations(const std::vector<Voxel>& a, const std::vector<Voxel>& b, double resolution_m) : of_a(a.size()) {
    std::vector<Eigen::Vector3f> centres;
    for (const Voxel& v : a) centres.push_back(v.centre);
    const auto gate = static_cast<float>(std::sqrt(3.0) * resolution_m);
    const matching::PointGrid grid(centres, 2 * gate);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int nearest = grid.nearest(b[j].centre, gate, [&](int i, float squared) {
        return distance(a[static_cast<std::size_t>(i)], b[j], squared);
      });
      (nearest == matching::PointGrid::kNone ? alone : of_a[static_cast<std::size_t>(nearest)]).push_back(j);
    }
  }
};

/// M-step (7.19, 7.20) of one voxel of a and its partners, and what each of them was before.
void add_fused(const Voxel& a, const std::vector<Voxel>& b, const std::vector<std::size_t>& partners,
               const merging::Limits& limits, EntropySum& whole, Sums& shared) {
  std::vector<float> opinions{a.log_odds};
  std::vector<ClassProbabilities> labels;
  if (a.label) labels.push_back(*a.label);
  for (const std::size_t j : partners) {
    opinions.push_back(b[j].log_odds);
    if (b[j].label) labels.push_back(*b[j].label);
  }
  const double occupancy = merging::probability(merging::fold(merging::Policy::kBayes, opinions, limits));
  const auto label = labels.empty() ? std::nullopt : std::optional(merging::fuse_labels(labels));
  whole.add(occupancy, label);
  if (partners.empty()) return;
  const bool both = a.label && labels.size() > 1;  // a label of one robot alone would be fused with nothing
  shared.a.add(a.occupancy(), both ? a.label : std::nullopt);
  for (const std::size_t j : partners) shared.b.add(b[j].occupancy(), both ? b[j].label : std::nullopt);
  shared.fused.add(occupancy, both ? label : std::nullopt);
}

void add_by_the_books_rules(const MapPair& pair, const SE3& T_a_b, FusedEntropies& entropies) {
  const mapping::SensorModel model = pair.a->sensor_model();
  const auto a = voxels_of(*pair.a, {}), b = voxels_of(*pair.b, T_a_b);
  const Associations associations(a, b, pair.a->getResolution());
  EntropySum whole;
  Sums shared;
  for (std::size_t i = 0; i < a.size(); ++i)
    add_fused(a[i], b, associations.of_a[i], {model.min, model.max, model.occupied}, whole, shared);
  for (const std::size_t j : associations.alone) whole.add(b[j].occupancy(), b[j].label);
  entropies.whole = {entropies_of(*pair.a), entropies_of(*pair.b), whole.mean()};
  entropies.shared = shared.mean();
}

/// A team's map of some of the pair's maps, by robots' numbers: 1 is a, 2 is b.
std::unique_ptr<SemanticOcTree> team_map(const MapPair& pair, const SE3& T_a_b,
                                         const std::vector<std::uint64_t>& robots) {
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
  FusedPair done;
  add_by_the_books_rules(pair, T_a_b, done.entropies);
  done.told_map = team_map(pair, T_a_b, {1, 2});
  // One robot's in its own frame: turned into another grid, voxels are lost and doubled.
  done.entropies.told = {entropies_of(*team_map(pair, T_a_b, {1})), entropies_of(*team_map(pair, {}, {2})),
                         entropies_of(*done.told_map)};
  return done;
}

}  // namespace cairn::protocol
