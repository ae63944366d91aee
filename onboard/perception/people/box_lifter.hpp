// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/people/cluster_finder.hpp"
#include "onboard/perception/people/eye_offset.hpp"

namespace cairn::people {

/// What a detector said of a cluster.
enum class Verdict : std::uint8_t {
  kNothing,  ///< out of view, too far, or something nearer is before it
  kPerson,   ///< a box of a person belongs to it
  kSilence,  ///< in view, and no box belongs to it
};

/// The verdict on one cluster.
struct Answer {
  Verdict verdict = Verdict::kNothing;
  float score = 0;      ///< of the box
  double distance = 0;  ///< m along the view
};

/// Where the points of somebody are who has a box and no cluster.
struct Lifted {
  Eigen::Vector2d position{0, 0};  ///< of the body's middle, odom, m
  float ground = 0;                ///< z of the ground there
  float score = 0;                 ///< of the box
};

/// Boxes of a picture → the clusters that they belong to. A box takes the cluster in whose direction it is, that is as
/// high in the picture as a person would be there, and that no other stands before. Depth comes from the scan alone.
class BoxLifter {
 public:
  /// `T_base_camera`: the mount, in body axes. Beyond `farthest_m` silence means nothing.
  BoxLifter(const cameras::CameraModel& camera, const SE3& T_base_camera, double farthest_m);

  /// `T_odom_base`: when the picture was taken. One answer for each cluster; valid until the next call.
  std::span<const Answer> judge(const Detections& boxes, std::span<const Cluster> clusters, const SE3& T_odom_base);
  /// Of the same picture: boxes that are of none of the clusters, and the nearest of these points that are in their
  /// direction and as far away as the box is high. The ground is not told.
  [[nodiscard]] std::vector<Lifted> lift(std::span<const Eigen::Vector3f> points_odom);

  /// The boxes that must be those of `people`: no other box or person is within kBeside of them, and they are as high
  /// as they would be. People nearer than kNotTooNear are left out: so near, a body has many directions. Valid until
  /// the next call.
  struct Known {
    std::uint32_t id = 0;
    Cluster body;
  };
  std::span<const BoxBeside> offsets(const Detections& boxes, std::span<const Known> people, const SE3& T_odom_base);
  static constexpr double kNotTooNear = 3;  ///< m
  static constexpr double kBeside = 0.1;    ///< rad

 private:
  /// In the optical frame at depth 1: x to the right, y down.
  struct Box {
    double left, right, top, bottom;
    bool open_top, open_bottom;  // cut by the picture's rim
    float score;
  };
  struct Seen {
    bool in_front = false, in_view = false;
    bool porous = false;                // no box is of it
    double x = 0, top = 0, bottom = 0;  // at depth 1
    double depth = 0, half_width = 0;
  };
  [[nodiscard]] Seen look_at(const Cluster& cluster, const SE3& T_optical_odom) const;
  [[nodiscard]] std::optional<Box> box_of(const Detection& found, const Detections& picture) const;
  [[nodiscard]] double mismatch(const Box& box, const Seen& seen) const;
  void assign(const Detections& boxes);
  [[nodiscard]] bool covered(std::size_t i) const;
  [[nodiscard]] std::optional<Lifted> lift(const Box& box, std::span<const Eigen::Vector3f> points_odom) const;

  cameras::CameraModel camera_;
  SE3 T_optical_base_;
  double farthest_;
  std::vector<Seen> seen_;
  std::vector<Answer> answers_;
  std::vector<Box> apart_;  // boxes of none of the clusters
  SE3 T_optical_odom_;
  std::vector<std::uint32_t> order_;
  std::vector<BoxBeside> offsets_;
};

}  // namespace cairn::people
