// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

namespace cairn::client {

/// Makes clouds of their parts. A cloud of which a part is missing is left out. Memory is bounded by Part::kMaxPoints.
/// Cloud::begin(part) makes a Cloud without points; the other parameters are the members that hold points.
template <class Part, class Cloud, auto kPartPoints, auto kCloudPoints>
class CloudAssembly {
 public:
  /// The cloud that this part completes, if it does.
  [[nodiscard]] std::optional<Cloud> take(Part part) {
    if (part.first == 0) cloud_ = Cloud::begin(part);
    const bool follows = cloud_ && cloud_->stamp == part.stamp && ((*cloud_).*kCloudPoints).size() == part.first;
    if (!follows) {
      cloud_.reset();
      return std::nullopt;
    }
    auto& points = (*cloud_).*kCloudPoints;
    const auto& more = part.*kPartPoints;
    points.insert(points.end(), more.begin(), more.end());
    if (points.size() < part.total) return std::nullopt;
    return std::exchange(cloud_, std::nullopt);
  }

 private:
  std::optional<Cloud> cloud_;
};

}  // namespace cairn::client
