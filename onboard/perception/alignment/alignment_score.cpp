// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/alignment_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::alignment {
namespace {

constexpr std::array<std::string_view, AlignmentScore::kMounts> kNames{
    "as given", "roll +0.5", "roll -0.5", "pitch +0.5", "pitch -0.5", "yaw +0.5", "yaw -0.5"};

constexpr int kMostSteps = 40;  // along an edge's uncertainty; about a pixel each

/// Mount `i` in the frame of the given one.
SE3 turned(std::size_t i) {
  Vector6 xi = Vector6::Zero();
  if (i > 0) xi[static_cast<Eigen::Index>(3 + (i - 1) / 2)] = (i % 2 == 1 ? 1 : -1) * AlignmentScore::kTurn_deg;
  return SE3::exp(xi * std::numbers::pi / 180);
}

}  // namespace

AlignmentScore::AlignmentScore(const cameras::CameraModel& camera, const SE3& T_base_camera) : camera_(camera) {
  for (std::size_t i = 0; i < kMounts; ++i)
    T_optical_base_[i] = (T_base_camera * turned(i) * cameras::T_camera_optical()).inverse();
}

std::optional<float> AlignmentScore::distance(const PictureEdges& picture, const DepthEdge& edge, std::size_t mount,
                                              const SE3& T_exposure_scan) const {
  const SE3 T = T_optical_base_[mount] * T_exposure_scan;
  const auto from = camera_.project(T * edge.inside_base.cast<double>());
  const auto to = camera_.project(T * edge.outside_base.cast<double>());
  if (!from || !to) return std::nullopt;
  const int steps = std::min(kMostSteps, static_cast<int>(std::ceil((*to - *from).norm())) + 1);
  float nearest = PictureEdges::kFar;
  for (int i = 0; i <= steps; ++i)
    nearest = std::min(nearest, picture.distance(edge.kind, *from + (*to - *from) * (static_cast<double>(i) / steps)));
  return nearest;
}

void AlignmentScore::add(const PictureEdges& picture, std::span<const DepthEdge> edges, const SE3& T_scan_exposure) {
  ++pictures_;
  const SE3 T_exposure_scan = T_scan_exposure.inverse();
  for (const DepthEdge& edge : edges) {
    std::array<float, kMounts> found{};
    bool seen = true;
    for (std::size_t i = 0; i < kMounts && seen; ++i) {
      const auto nearest = distance(picture, edge, i, T_exposure_scan);
      seen = nearest.has_value();
      if (seen) found[i] = *nearest;
    }
    if (!seen) continue;
    ++edges_;
    for (std::size_t i = 0; i < kMounts; ++i)
      ++histograms_[i][static_cast<std::size_t>(std::lround(found[i] * kBins / PictureEdges::kFar))];
  }
}

std::array<EdgeDistance, AlignmentScore::kMounts> AlignmentScore::distances() const {
  constexpr double kBin_px = PictureEdges::kFar / static_cast<double>(kBins);
  constexpr auto kTwo = static_cast<std::size_t>(2 / kBin_px + 0.5);
  std::array<EdgeDistance, kMounts> all;
  for (std::size_t i = 0; i < kMounts; ++i) {
    all[i].mount = kNames[i];
    std::size_t below = 0, bin = 0, near = 0;
    for (; bin < kBins && 2 * (below + histograms_[i][bin]) < edges_; ++bin) below += histograms_[i][bin];
    for (std::size_t b = 0; b <= kTwo; ++b) near += histograms_[i][b];
    double close = 0;
    for (std::size_t b = 0; b <= kBins; ++b)
      close += static_cast<double>(histograms_[i][b]) * std::exp(-std::pow(static_cast<double>(b) * kBin_px / 2, 2));
    all[i].median_px = static_cast<double>(bin) * kBin_px;
    all[i].within_2px = edges_ == 0 ? 0 : static_cast<double>(near) / static_cast<double>(edges_);
    all[i].closeness = edges_ == 0 ? 0 : close / static_cast<double>(edges_);
  }
  return all;
}

bool AlignmentScore::given_mount_is_best() const {
  const auto all = distances();
  return std::all_of(all.begin() + 1, all.end(),
                     [&](const EdgeDistance& turned) { return turned.closeness < all[0].closeness; });
}

}  // namespace cairn::alignment
