// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::team {

/// What is known of where one node of a pose graph lies in another. Its covariance is positive definite.
struct RelativePose {
  std::size_t a = 0, b = 0;
  UncertainPose T_a_b;
};

/// Where the nodes of a pose graph lie. The frame is that of the first, which is fixed.
struct PoseGraph {
  std::vector<SE3> poses;
  Eigen::SparseMatrix<double> information;  ///< of all nodes but the first, six rows each, right perturbations
};

/// Least squares weighted by the covariances (Gauss–Newton on a sparse graph), from a first guess of every node. What
/// is known connects all nodes. A pure function of its arguments; it takes milliseconds for a hundred nodes.
[[nodiscard]] PoseGraph solve(std::vector<SE3> start, std::span<const RelativePose> known);

/// What a solved graph knows of pairs of its nodes. The graph must outlive it.
class Marginals {
 public:
  explicit Marginals(const PoseGraph& graph);
  /// Where b lies in a, by all that is known.
  [[nodiscard]] UncertainPose between(std::size_t a, std::size_t b) const;

 private:
  const PoseGraph& graph_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace cairn::team
