// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// A map seen from above, in columns of 0.4 m (more, where it spreads over more than 512² of them): where walls stand,
/// which way they face, where there is room. Gravity is along z of the map.
class PlanView {
 public:
  struct Column {
    Eigen::Vector2f at;                                ///< m; middle of the walls, or of the column
    float mass = 0;                                    ///< of walls, 0…1
    Eigen::Vector2f facing = Eigen::Vector2f::Zero();  ///< their mean normal towards free space, times the mass
    float open = 0;                                    ///< observed free and no wall, 0…1
  };
  struct Height {
    float z;
    bool level;  ///< a floor, a ceiling, a table
  };

  /// `surfels`: fine ones, facing free space where it is known which way that is.
  PlanView(std::span<const Surfel> surfels, const SemanticOcTree& map);

  /// Those with walls or room, row by row.
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const Eigen::Vector2f& low() const { return low_; }  ///< of the walls, m
  [[nodiscard]] const Eigen::Vector2f& high() const { return high_; }
  [[nodiscard]] const Eigen::Vector2f& middle() const { return middle_; }
  [[nodiscard]] float radius() const { return radius_; }  ///< of the walls about the middle, m
  /// Of the surfels in the column at a place.
  [[nodiscard]] std::span<const Height> heights(const Eigen::Vector2f& at) const;
  /// How many upright surfels face along each degree of the half circle, smoothed.
  [[nodiscard]] const std::vector<float>& directions() const { return directions_; }

 private:
  struct Walls {
    float count = 0, room_m3 = 0;
    Eigen::Vector2f at = Eigen::Vector2f::Zero(), facing = Eigen::Vector2f::Zero();
  };
  void lay_out(std::span<const Surfel> surfels);
  void stack_heights(std::span<const Surfel> surfels);
  void add_room(const SemanticNode* node, const Eigen::Vector3i& first, int edge, const SemanticOcTree& map,
                std::vector<Walls>& walls) const;
  void look_around(std::span<const Surfel> surfels);
  void measure();
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2f& at) const {
    return ((at - corner_) / cell_m_).array().floor().cast<int>();
  }
  [[nodiscard]] std::size_t slot(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(cell.x());
  }

  float cell_m_ = 0.4F;
  Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();
  Eigen::Vector2i size_ = Eigen::Vector2i::Ones();
  std::vector<Column> columns_;
  std::vector<std::size_t> starts_;  // of each column's heights, and the end
  std::vector<Height> heights_;
  std::vector<float> directions_;
  Eigen::Vector2f low_ = Eigen::Vector2f::Zero(), high_ = low_, middle_ = low_;
  float radius_ = 0;
};

/// Upright, level or neither; a surface that is not flat is neither.
[[nodiscard]] inline bool is_upright(const Surfel& s) { return std::abs(s.normal.z()) < 0.4F && !s.normal.isZero(); }
[[nodiscard]] inline bool is_level(const Surfel& s) { return std::abs(s.normal.z()) > 0.85F; }

}  // namespace cairn::matching
