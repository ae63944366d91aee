// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/structural_edges.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdint>

#include "fusion/matching/book/point_grid.hpp"
#include "fusion/matching/features/cell_index.hpp"
#include "fusion/matching/features/sample.hpp"

namespace cairn::matching {
namespace {

// The book leaves all of these out but the angles. Chosen by hand, not tuned.
constexpr std::size_t kMinNeighbours = 5;  // occupied voxels for a normal
constexpr float kDegree_rad = 0.0174532925F;
constexpr int kHalfCircle_deg = 180;
// Least angle that two walks enclose at an edge (Alg. 2); the largest is 100°.
constexpr float kSquarest_deg = 80;
constexpr int kMaxWalk_voxels = 16;        // a bound on time; the book's d_T is 5 voxels
constexpr float kLeastGain_voxels = 0.2F;  // a step of a walk that leads less far ends it
constexpr float kLeastWalk = 0.5F;         // of d_T, for a walk to count
// Of the neighbours that give an edge its direction (4.5).
constexpr double kEdgeRadius_cells = 5;
constexpr double kOutlierCell_voxels = 5;  // edge of a cell of PointGrid. For time only
// What an edge voxel without neighbours counts as its mean distance.
constexpr double kOutlierGate_voxels = 50;
constexpr double kUniform = 12;    // a uniform distribution of width d has variance d²/12
constexpr double kHalfVoxel2 = 4;  // (d/2)² = d²/4

/// Voxels by their keys.
class Surface {
 public:
  Surface(std::span<const Voxel> voxels, double radius_cells) : voxels_(voxels), index_(voxels.size()) {
    for (std::size_t i = 0; i < voxels.size(); ++i) index_.find_or_insert(pack(voxels[i].key), static_cast<int>(i));
    const int r = static_cast<int>(radius_cells);
    for (int x = -r; x <= r; ++x)
      for (int y = -r; y <= r; ++y)
        for (int z = -r; z <= r; ++z)
          if (x * x + y * y + z * z <= radius_cells * radius_cells) ball_.push_back(step_of({x, y, z}));
  }
  template <class Use>
  void around(const Voxel& v, const Use& use) const {
    const std::uint64_t home = pack(v.key);
    for (const std::uint64_t step : ball_)
      if (const int i = index_.find(home + step); i != CellIndex::kNone) use(static_cast<std::size_t>(i));
  }
  /// The difference of pack() between a key and that of a neighbour. Sums do not overflow, because
  /// keys have fewer bits than pack() allows.
  [[nodiscard]] static std::uint64_t step_of(const Eigen::Vector3i& step) {
    return pack(step) - pack(Eigen::Vector3i::Zero());
  }
  [[nodiscard]] std::span<const Voxel> voxels() const { return voxels_; }
  [[nodiscard]] int find(std::uint64_t packed_key) const { return index_.find(packed_key); }

 private:
  std::span<const Voxel> voxels_;
  CellIndex index_;
  std::vector<std::uint64_t> ball_;
};

/// The voxels that touch each voxel, looked up once for the thousands of steps that follow.
class Paths {
 public:
  explicit Paths(const Surface& surface) : voxels_(surface.voxels()) {
    std::array<std::uint64_t, 27> steps{};
    for (int k = 0; k < 27; ++k)
      steps[static_cast<std::size_t>(k)] = Surface::step_of({k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1});
    for (const Voxel& v : voxels_) {
      starts_.push_back(touching_.size());
      for (const std::uint64_t step : steps)
        if (const int i = surface.find(pack(v.key) + step); step != 0 && i != CellIndex::kNone) touching_.push_back(i);
    }
    starts_.push_back(touching_.size());
  }
  /// Walks from a voxel over touching ones, always to that which leads farthest along `direction`.
  [[nodiscard]] Eigen::Vector3f walk(std::size_t from, const Eigen::Vector3f& direction, float length, float d) const {
    const Eigen::Vector3f& start = voxels_[from].centre;
    std::size_t at = from;
    for (int step = 0; step < kMaxWalk_voxels && (voxels_[at].centre - start).norm() < length; ++step) {
      const std::size_t next = step_along(at, direction, kLeastGain_voxels * d);
      if (next == at) break;
      at = next;
    }
    return voxels_[at].centre - start;
  }

 private:
  [[nodiscard]] std::size_t step_along(std::size_t at, const Eigen::Vector3f& direction, float least) const {
    std::size_t next = at;
    for (std::size_t k = starts_[at]; k < starts_[at + 1]; ++k) {
      const auto i = static_cast<std::size_t>(touching_[k]);
      const float gain = direction.dot(voxels_[i].centre - voxels_[at].centre);
      if (gain > least) {
        least = gain;
        next = i;
      }
    }
    return next;
  }

  std::span<const Voxel> voxels_;
  std::vector<std::size_t> starts_;
  std::vector<int> touching_;
};

std::vector<Eigen::Vector3f> normals_of(const Surface& surface, std::span<const Voxel> voxels) {
  std::vector<Eigen::Vector3f> normals(voxels.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    std::size_t n = 0;
    surface.around(voxels[i], [&](std::size_t j) {
      const Eigen::Vector3f v = voxels[j].centre - voxels[i].centre;
      sum += v;
      squares += v * v.transpose();
      ++n;
    });
    if (n < kMinNeighbours) continue;
    const Eigen::Vector3f mean = sum / static_cast<float>(n);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(squares / static_cast<float>(n) - mean * mean.transpose());
    normals[i] = solver.eigenvectors().col(0);
  }
  return normals;
}

/// The voxels whose normals differ from their neighbours' by more than κ on average (4.4).
std::vector<std::size_t> candidates(const Surface& surface, std::span<const Voxel> voxels,
                                    std::span<const Eigen::Vector3f> normals, double min_angle_cost) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (normals[i].isZero()) continue;
    float cost = 0, n = 0;
    surface.around(voxels[i], [&](std::size_t j) {
      if (j == i || normals[j].isZero()) return;
      cost += normals[j].cross(normals[i]).norm();
      n += 1;
    });
    if (static_cast<double>(cost) > min_angle_cost * static_cast<double>(n)) found.push_back(i);
  }
  return sample(std::span<const std::size_t>(found), kMostCandidates);
}

bool turns_a_corner(const Paths& paths, std::size_t v, const Eigen::Vector3f& n, double d, const EdgeOptions& options) {
  const Eigen::Vector3f u = n.unitOrthogonal(), w = n.cross(u);
  const auto length = static_cast<float>(options.trace_m);
  for (int degrees = 0; degrees < kHalfCircle_deg; degrees += options.step_deg) {
    const float theta = kDegree_rad * static_cast<float>(degrees);
    const Eigen::Vector3f direction = std::cos(theta) * u + std::sin(theta) * w;
    const Eigen::Vector3f a = paths.walk(v, direction, length, static_cast<float>(d));
    const Eigen::Vector3f b = paths.walk(v, -direction, length, static_cast<float>(d));
    const float norms = a.norm() * b.norm();
    if (a.norm() < kLeastWalk * length || b.norm() < kLeastWalk * length) continue;
    if (std::abs(a.dot(b)) <= std::cos(kSquarest_deg * kDegree_rad) * norms) return true;
  }
  return false;
}

std::vector<Voxel> without_outliers(const std::vector<Voxel>& voxels, double d, int k) {
  std::vector<Eigen::Vector3f> points;
  for (const Voxel& v : voxels) points.push_back(v.centre);
  const PointGrid grid(points, static_cast<float>(kOutlierCell_voxels * d));
  std::vector<double> distances;
  std::vector<PointGrid::Neighbour> near;
  double sum = 0, squares = 0;
  const auto gate = static_cast<float>(kOutlierGate_voxels * d);
  for (const Eigen::Vector3f& p : points) {
    grid.nearest(p, gate, static_cast<std::size_t>(k + 1), near);  // the first is the point itself
    double mean = near.size() < 2 ? static_cast<double>(gate) : 0;
    for (std::size_t i = 1; i < near.size(); ++i)
      mean += std::sqrt(static_cast<double>(near[i].squared)) / static_cast<double>(near.size() - 1);
    distances.push_back(mean);
    sum += mean;
    squares += mean * mean;
  }
  const auto n = std::max(1.0, static_cast<double>(voxels.size()));
  const double sigma = std::sqrt(std::max(0.0, squares / n - sum / n * sum / n));
  std::vector<Voxel> kept;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (distances[i] <= sum / n + sigma) kept.push_back(voxels[i]);
  return kept;
}

/// Directions and covariances from the edge voxels around each (4.5, 4.8, 4.14).
void describe(StructuralEdges& edges, double d) {
  const Surface line(edges.voxels, kEdgeRadius_cells);
  double quality = 0;
  for (const Voxel& v : edges.voxels) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    float n = 0;
    line.around(v, [&](std::size_t j) {
      const Eigen::Vector3f x = edges.voxels[j].centre - v.centre;
      sum += x;
      squares += x * x.transpose();
      n += 1;
    });
    const Eigen::Vector3f mean = sum / n;
    const auto quantisation = static_cast<float>(d * d / kUniform);
    const Eigen::Matrix3f spread = squares / n - mean * mean.transpose() + quantisation * Eigen::Matrix3f::Identity();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(spread);
    edges.directions.emplace_back(solver.eigenvectors().col(2));
    quality += static_cast<double>(solver.eigenvalues()[2] / solver.eigenvalues().sum());
    edges.covariances.emplace_back((voxel_covariance(v, d).inverse() + spread.inverse()).inverse());
  }
  if (!edges.voxels.empty()) edges.quality = quality / static_cast<double>(edges.voxels.size());
}

}  // namespace

Eigen::Matrix3f voxel_covariance(const Voxel& voxel, double resolution_m) {
  return static_cast<float>(resolution_m * resolution_m / kHalfVoxel2) / voxel.occupancy * Eigen::Matrix3f::Identity();
}

std::vector<Eigen::Vector3f> voxel_normals(std::span<const Voxel> voxels, double radius_cells) {
  return normals_of(Surface(voxels, radius_cells), voxels);
}

StructuralEdges structural_edges(std::span<const Voxel> voxels, double resolution_m, const EdgeOptions& options) {
  const Surface surface(voxels, options.normal_radius_cells);
  const auto normals = normals_of(surface, voxels);
  const Paths paths(surface);
  std::vector<Voxel> corners;
  for (const std::size_t i : candidates(surface, voxels, normals, options.min_angle_cost))
    if (turns_a_corner(paths, i, normals[i], resolution_m, options)) corners.push_back(voxels[i]);
  StructuralEdges edges;
  edges.voxels = without_outliers(corners, resolution_m, options.outlier_neighbours);
  describe(edges, resolution_m);
  return edges;
}

}  // namespace cairn::matching
