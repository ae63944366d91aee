// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::people {

/// How far a detector's answer can be trusted. Its shares are those of person-sized clusters in view. The defaults are
/// what `cairn evaluate detectors` counts on simulated drives; see docs/people.md.
struct DetectorTrust {
  double recall = 0.64;        ///< of people in view and near enough, those that it finds
  double false_share = 0.021;  ///< of other person-sized things in view, those that it takes for people
  double usual_score = 0.59;   ///< of a box that shows a person
  double score_slope = 10.4;   ///< nats that a box counts more for each 1 of a larger score; 0: all boxes count alike
  double farthest_m = 10;      ///< from here on, silence of the detector means nothing

  /// What a box says of the cluster that it belongs to, nats. A box with the usual score says what the sequential test
  /// says of any box (Wald, 1945): ln(recall / false_share). From there it is a straight line (Platt, 1999). A weak box
  /// says nothing against a person, and a single box is never sure.
  [[nodiscard]] double of_box(double score) const;
  /// What no box says of a cluster in full view at this distance, nats: negative, and 0 from farthest_m on. The recall
  /// falls with the square of the distance.
  [[nodiscard]] double of_silence(double distance_m) const;
  static constexpr double kMostOfABox = 5;  ///< nats; a few hundred boxes cannot show more
};

}  // namespace cairn::people
