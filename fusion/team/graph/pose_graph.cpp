// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/pose_graph.hpp"

#include <Eigen/LU>
#include <array>
#include <utility>

namespace cairn::team {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int kIterations = 10;

/// The normal equations at the poses, for all but the first of them.
class Equations {
 public:
  explicit Equations(const std::vector<SE3>& poses) : poses_(poses), g_(Eigen::VectorXd::Zero(size())) {}

  /// Residual log(T_a_b⁻¹ T_a⁻¹ T_b), right perturbations.
  void add(const RelativePose& known) {
    const SE3 T_ab = poses_[known.a].inverse() * poses_[known.b];
    const Vector6 r = (known.T_a_b.mean.inverse() * T_ab).log();
    const Matrix6 J_b = right_jacobian_inverse(r), J_a = -J_b * T_ab.inverse().adjoint();
    const Matrix6 information = known.T_a_b.covariance.inverse();
    const std::array<std::pair<std::size_t, const Matrix6*>, 2> ends{{{known.a, &J_a}, {known.b, &J_b}}};
    for (const auto& [i, J_i] : ends) {
      if (i == 0) continue;
      const Matrix6 J_i_information = J_i->transpose() * information;
      g_.segment<6>(row(i)) += J_i_information * r;
      for (const auto& [k, J_k] : ends)
        if (k != 0) put(row(i), row(k), J_i_information * *J_k);
    }
  }
  [[nodiscard]] Sparse matrix() const {
    Sparse H(size(), size());
    H.setFromTriplets(entries_.begin(), entries_.end());
    return H;
  }
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return g_; }
  static Eigen::Index row(std::size_t node) { return 6 * (static_cast<Eigen::Index>(node) - 1); }

 private:
  [[nodiscard]] Eigen::Index size() const { return row(poses_.size()); }
  void put(Eigen::Index row, Eigen::Index column, const Matrix6& block) {
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index k = 0; k < 6; ++k)
        entries_.emplace_back(static_cast<int>(row + i), static_cast<int>(column + k), block(i, k));
  }

  const std::vector<SE3>& poses_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd g_;
};

Equations equations(const std::vector<SE3>& poses, std::span<const RelativePose> known) {
  Equations all(poses);
  for (const RelativePose& k : known) all.add(k);
  return all;
}

/// A step of Gauss–Newton, where there is one.
void descend(std::vector<SE3>& poses, std::span<const RelativePose> known) {
  const Equations at = equations(poses, known);
  const Eigen::SimplicialLDLT<Sparse> factors(at.matrix());
  if (factors.info() != Eigen::Success) return;
  const Eigen::VectorXd step = factors.solve(-at.gradient());
  if (!step.allFinite()) return;
  for (std::size_t node = 1; node < poses.size(); ++node)
    poses[node] = poses[node] * SE3::exp(step.segment<6>(Equations::row(node)));
}

}  // namespace

PoseGraph solve(std::vector<SE3> start, std::span<const RelativePose> known) {
  PoseGraph graph{std::move(start), {}};
  if (graph.poses.size() < 2) return graph;
  for (int i = 0; i < kIterations; ++i) descend(graph.poses, known);
  graph.information = equations(graph.poses, known).matrix();
  return graph;
}

Marginals::Marginals(const PoseGraph& graph) : graph_(graph) {
  if (graph.poses.size() > 1) factors_.compute(graph.information);
}

UncertainPose Marginals::between(std::size_t a, std::size_t b) const {
  UncertainPose T_a_b{graph_.poses[a].inverse() * graph_.poses[b], Matrix6::Zero()};
  if (a == b) return T_a_b;
  // How the perturbations of both ends perturb T_a_b, transposed.
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(graph_.information.rows(), 6);
  if (a != 0) J.middleRows<6>(Equations::row(a)) = -T_a_b.mean.inverse().adjoint().transpose();
  if (b != 0) J.middleRows<6>(Equations::row(b)).setIdentity();
  const Eigen::MatrixXd spread = factors_.solve(J);
  T_a_b.covariance = J.transpose() * spread;
  T_a_b.covariance = 0.5 * (T_a_b.covariance + T_a_b.covariance.transpose()).eval();
  return T_a_b;
}

}  // namespace cairn::team
