// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/nearest_grid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace cairn::matching {
namespace {

// Coordinate of a cell, half of what pack() can tell apart.
constexpr float kMaxCell = 1 << 19;
constexpr std::size_t kSurfelsPerBrick = 8;  // a guess for the index's first size
constexpr std::size_t kLeastBricks = 16;     // the same, of small maps

Eigen::Vector3i brick_of(const Eigen::Vector3i& cell, int bits) {
  return {cell.x() >> bits, cell.y() >> bits, cell.z() >> bits};
}

template <class Visit>
void for_all(const Eigen::Vector3i& first, const Eigen::Vector3i& last, const Visit& visit) {
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) visit(Eigen::Vector3i(x, y, z));
}

}  // namespace

/// Fills one brick: each surfel is offered to the cells in its reach, some rows at once, so that the compiler can
/// vectorise.
class NearestGrid::Filling {
 public:
  Filling(Brick& brick, const Eigen::Vector3i& place, float cell_m, float reach_m)
      : brick_(brick), place_(place), cell_m_(cell_m), squared_reach_(reach_m * reach_m) {
    brick.fill(kNone);
    nearest_m2_.fill(squared_reach_);
  }

  /// Of two that are equally near, the first that is offered stays.
  void offer(int surfel, const Eigen::Vector3f& point) {
    const Row x2 = squares(point, 0), y2 = squares(point, 1), z2 = squares(point, 2);
    const float least_x2 = *std::min_element(x2.begin(), x2.end());
    Layer of_layer;
    bool laid = false;
    for (std::size_t z = 0; z < kEdge; ++z) {
      const auto reached = [&](float in_y) { return least_x2 + in_y + z2[z] < squared_reach_; };
      const auto first = std::find_if(y2.begin(), y2.end(), reached), last = std::find_if_not(first, y2.end(), reached);
      if (first == last) continue;
      for (std::size_t i = 0; i < of_layer.size() && !laid; ++i) of_layer[i] = x2[i % kEdge] + y2[i / kEdge];
      laid = true;
      const auto from = kEdge * static_cast<std::size_t>(first - y2.begin());
      const std::size_t at = kEdge * kEdge * z + from;
      keep(surfel, &of_layer[from], z2[z], kEdge * static_cast<std::size_t>(last - first), &nearest_m2_[at],
           &brick_[at]);
    }
  }

 private:
  using Row = std::array<float, kEdge>;
  using Layer = std::array<float, kEdge * kEdge>;

  /// Squared distances of a point from the centres of the brick's cells along one axis, m².
  [[nodiscard]] Row squares(const Eigen::Vector3f& point, int axis) const {
    Row all{};
    for (int k = 0; k < 1 << kBits; ++k) {
      const float off = point[axis] - (static_cast<float>((place_[axis] << kBits) + k) + 0.5F) * cell_m_;
      all[static_cast<std::size_t>(k)] = off * off;
    }
    return all;
  }

  /// Written so that the compiler vectorises it.
  static void keep(int surfel, const float* xy2, float z2, std::size_t cells, float* nearest_m2, int* held) {
    for (std::size_t k = 0; k < cells; ++k) {
      const float squared_m = xy2[k] + z2;
      const int nearer = -static_cast<int>(squared_m < nearest_m2[k]);  // all bits or none
      held[k] ^= (held[k] ^ surfel) & nearer;
      nearest_m2[k] = std::min(squared_m, nearest_m2[k]);
    }
  }

  Brick& brick_;
  Eigen::Vector3i place_;
  float cell_m_, squared_reach_;
  // Of what the cells hold, m²; the squared reach where they hold nothing.
  std::array<float, std::tuple_size_v<Brick>> nearest_m2_;
};

NearestGrid::NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m)
    : surfels_(surfels),
      cell_m_(cell_m),
      inverse_cell_(1.0F / cell_m),
      reach_m_(reach_m),
      index_(surfels.size() / kSurfelsPerBrick + kLeastBricks) {
  std::vector<Home> homes;
  settle(homes);
  reach_out(homes);
  cells_of_.assign(index_.size(), -kFewQuestions);
}

Eigen::Vector3i NearestGrid::brick_around(const Eigen::Vector3f& point) const {
  return brick_of((point * inverse_cell_).array().floor().cast<int>(), kBits);
}

/// The number of a brick, which is entered if need be; kNone beyond kMostBricks.
int NearestGrid::number_of(const Eigen::Vector3i& place) {
  if (index_.size() == kMostBricks) return index_.find(place);
  return index_.find_or_insert(pack(place), static_cast<int>(index_.size()));
}

/// Sorts the surfels by the bricks in which they lie, and by their numbers there.
void NearestGrid::settle(std::vector<Home>& homes) {
  std::vector<int> home_of(surfels_.size());
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    const Eigen::Vector3i place = brick_around(surfels_[i].point);
    home_of[i] = number_of(place);
    if (home_of[i] == kNone) continue;
    const auto home = static_cast<std::size_t>(home_of[i]);
    if (home == homes.size()) homes.push_back({place, {}});
    homes[home].box.extend(surfels_[i].point);
  }
  first_.assign(homes.size() + 1, 0);
  for (const int home : home_of)
    if (home != kNone) ++first_[static_cast<std::size_t>(home) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  settled_.resize(static_cast<std::size_t>(first_.back()));
  points_.resize(settled_.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    if (home_of[i] == kNone) continue;
    const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(home_of[i])]++);
    settled_[at] = static_cast<int>(i);
    points_[at] = surfels_[i].point;
  }
}

/// Enters the bricks that hold no surfel, but lie within reach of one.
void NearestGrid::reach_out(const std::vector<Home>& homes) {
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(reach_m_);
  for (const Home& home : homes)
    for_all(brick_around(home.box.min() - reach), brick_around(home.box.max() + reach),
            [&](const Eigen::Vector3i& place) { (void)number_of(place); });
}

/// Visits the surfels of the bricks that a box meets, brick by brick, as places in settled_.
template <class Visit>
void NearestGrid::for_surfels(const Eigen::AlignedBox3f& box, const Visit& visit) const {
  for_all(brick_around(box.min()), brick_around(box.max()), [&](const Eigen::Vector3i& place) {
    const int i = index_.find(place);
    if (i == kNone || static_cast<std::size_t>(i) + 1 >= first_.size()) return;
    const auto at = static_cast<std::size_t>(i);
    for (auto k = static_cast<std::size_t>(first_[at]); k < static_cast<std::size_t>(first_[at + 1]); ++k) visit(k);
  });
}

/// The surfels within reach of a brick's cells, in order. Some are a little farther.
std::vector<int> NearestGrid::surfels_near(const Eigen::Vector3i& place) const {
  const float edge_m = static_cast<float>(kEdge) * cell_m_;
  const Eigen::Vector3f low = edge_m * place.cast<float>(), reach = Eigen::Vector3f::Constant(reach_m_);
  const Eigen::AlignedBox3f box(low, low + Eigen::Vector3f::Constant(edge_m));
  std::vector<int> all;
  for_surfels({box.min() - reach, box.max() + reach}, [&](std::size_t k) {
    if (box.squaredExteriorDistance(points_[k]) < reach_m_ * reach_m_) all.push_back(settled_[k]);
  });
  std::sort(all.begin(), all.end());
  return all;
}

/// What a filled brick holds in this cell. Of surfels that are equally near, the first.
int NearestGrid::look_for(const Eigen::Vector3i& cell) const {
  const Eigen::Vector3f centre = (cell.cast<float>().array() + 0.5F) * cell_m_;
  int nearest = kNone;
  float nearest_m2 = reach_m_ * reach_m_;
  const auto offer = [&](std::size_t k) {
    const Eigen::Vector3f off = points_[k] - centre;
    const float squared_m = off.x() * off.x() + off.y() * off.y() + off.z() * off.z();
    const bool first = squared_m == nearest_m2 && settled_[k] < nearest;
    if (squared_m >= nearest_m2 && !first) return;
    nearest = settled_[k];
    nearest_m2 = squared_m;
  };
  // Its own brick often holds one so near that few other bricks are within its distance.
  for_surfels({centre, centre}, offer);
  // A little farther, as for a brick, where half a cell lies between its face and the next centre.
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(std::sqrt(nearest_m2) + 0.5F * cell_m_);
  for_surfels({centre - reach, centre + reach}, offer);
  return nearest;
}

void NearestGrid::fill(std::size_t i, const Eigen::Vector3i& place) const {
  if (count_ % kChunk == 0) chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
  Filling filling((*chunks_.back())[count_ % kChunk], place, cell_m_, reach_m_);
  for (const int surfel : surfels_near(place)) filling.offer(surfel, surfels_[static_cast<std::size_t>(surfel)].point);
  cells_of_[i] = static_cast<int>(count_++);
}

/// The surfel that a cell of brick `i` knows.
int NearestGrid::nearest_to_centre(std::size_t i, const Eigen::Vector3i& cell) const {
  constexpr int kLastQuestion = -1;
  int& at = cells_of_[i];
  if (at < kLastQuestion) {
    ++at;
    return look_for(cell);
  }
  if (at == kLastQuestion) fill(i, brick_of(cell, kBits));
  return (*chunks_[static_cast<std::size_t>(at) / kChunk])[static_cast<std::size_t>(at) % kChunk][slot(cell)];
}

std::size_t NearestGrid::slot(const Eigen::Vector3i& cell) {
  constexpr int kMask = (1 << kBits) - 1;
  return static_cast<std::size_t>(((cell.z() & kMask) << kBits | (cell.y() & kMask)) << kBits | (cell.x() & kMask));
}

int NearestGrid::nearest(const Eigen::Vector3f& point, float gate_m) const {
  const Eigen::Vector3f scaled = point * inverse_cell_;
  if (!(scaled.cwiseAbs().maxCoeff() < kMaxCell) || scaled.hasNaN()) return kNone;
  const Eigen::Vector3i cell = scaled.array().floor().cast<int>();
  const int at = index_.find(brick_of(cell, kBits));
  if (at == CellIndex::kNone) return kNone;
  const int i = nearest_to_centre(static_cast<std::size_t>(at), cell);
  if (i == kNone || (surfels_[static_cast<std::size_t>(i)].point - point).squaredNorm() >= gate_m * gate_m)
    return kNone;
  return i;
}

}  // namespace cairn::matching
