// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "onboard/perception/people/box_lifter.hpp"
#include "onboard/perception/people/cluster_finder.hpp"
#include "onboard/perception/people/people_config.hpp"
#include "onboard/perception/people/track.hpp"

namespace cairn::people {

/// Clusters of scans and verdicts of detectors → tracks. Every cluster is followed; a track is a person once the
/// evidence is large enough: a sequential test (Wald, 1945), in which any number of cameras add up. What a detector
/// adds is in DetectorTrust. Walking adds as much as confirms.
class Tracker {
 public:
  static constexpr std::size_t kMostTracks = 256;  ///< people or not
  static constexpr double kClusterSigma = 0.12;    ///< m, on each axis, of a cluster's middle

  /// What is measured of somebody at this place who has no cluster, such as a person beside a wall or in a group; none:
  /// nothing. Points that are nearer to one of `others` are theirs.
  struct Beside {
    Eigen::Vector2d position{0, 0};  ///< odom, m
    float ground = 0;                ///< z of the ground there
    float passed = 0;                ///< see Cluster
  };
  using LookFor =
      std::function<std::optional<Beside>(const Eigen::Vector2d& position, std::span<const Eigen::Vector2d> others)>;
  /// Whether the scan's rays go through a place of this track: of a walk, the one where it began. For a walk also true
  /// of who came upright and does not slide along with the robot, and never of what is the robot's own.
  using SeenThrough = std::function<bool(const Track& track)>;

  explicit Tracker(const PeopleConfig& config) : config_(config) {}

  /// To the time of a later scan. Returns where those are expected whom a wide body may hold.
  std::span<const Eigen::Vector2d> predict(Time stamp);
  /// The clusters of the scan that predict() was called for.
  void step(Time stamp, std::span<const Cluster> clusters, const LookFor& look_for, const SeenThrough& seen_through,
            const SeenThrough& empty);
  /// Of the last scan: its clusters, and after them people who were found without one.
  [[nodiscard]] std::span<const Cluster> bodies() const { return bodies_; }
  /// What a detector said of the bodies of the scan at `stamp`, of the last two seconds.
  void hear(Time stamp, std::span<const Answer> answers, const DetectorTrust& trust);
  /// Whose body each of bodies() of the scan at `stamp` was: a person's id and its number in bodies().
  [[nodiscard]] std::vector<std::pair<std::uint32_t, std::size_t>> bodies_of_people(Time stamp) const;
  /// Boxes of the same picture that are of none of these bodies: where the scan has points in their direction. Somebody
  /// begins there, or was there already.
  void hear_apart(Time stamp, Time now, std::span<const Lifted> lifted, const DetectorTrust& trust);
  /// Evidence from elsewhere, in nats, for or against somebody; see people().
  void weigh(std::uint32_t id, double nats);
  void clear();

  /// The people, in the order of their ids. Valid until the next call.
  [[nodiscard]] std::span<const Person> people() const { return people_; }
  /// Who came into places that were free, and may yet turn out to be people. They are kept out of the map for a while.
  [[nodiscard]] std::span<const Person> newcomers() const { return newcomers_; }
  /// The tracks that have become people since the last call, with all that is known of their ways.
  [[nodiscard]] std::vector<const Track*> take_new();

 private:
  void associate(std::span<const Cluster> clusters);
  void find_again(std::span<const Cluster> clusters);
  void look_beside(const LookFor& look_for);
  void weigh_ways(Time stamp, std::span<const Cluster> clusters, const SeenThrough& seen_through);
  void weigh_places(Track& track, const Cluster& seen);
  [[nodiscard]] bool walks(const Track& track, const Cluster& seen, const SeenThrough& seen_through) const;
  void end_tracks(Time stamp);
  void begin_tracks(Time stamp, std::span<const Cluster> clusters);
  void judge(Track& track);
  void list_people();

  PeopleConfig config_;
  std::uint32_t next_id_ = 1;
  std::vector<Track> tracks_;
  std::vector<Person> people_, newcomers_;
  std::vector<Eigen::Vector2d> seeds_;
  std::vector<bool> taken_;  // clusters of the scan
  std::vector<Cluster> bodies_;
  struct Pair {
    double distance2;
    std::uint32_t track, cluster;
  };
  std::vector<Pair> pairs_;  // reused
};

}  // namespace cairn::people
