// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace cairn::people {
namespace {

constexpr double kGate2 = 9.21;                             // χ² of two directions, 99 %
constexpr double kFarthest = 1.2;                           // m from where a track is expected
constexpr double kBesideSigma = 0.25;                       // m: of what look_for finds
constexpr double kWalkEvidence = 6.5;                       // nats: walking confirms, whatever the prior says
constexpr double kDoubt = 0;                                // nats; below, a person is none any more
constexpr Duration kHope = std::chrono::milliseconds(300);  // for what has just been seen first
constexpr Duration kUnsure = std::chrono::seconds(3);       // for who stands beside something, and no camera sees
constexpr double kBody = 0.35;                              // m; nearer together two people cannot be
constexpr double kReach = 0.6;                              // m; from the middle of two to each of them
constexpr double kOneBody = 0.65;                           // m; two together are wider

}  // namespace

void Tracker::step(Time stamp, std::span<const Cluster> clusters, const LookFor& look_for,
                   const SeenThrough& seen_through) {
  for (Track& track : tracks_) {
    const double dt_s = to_seconds(stamp - track.person().stamp);
    track.predict(stamp);
    if (!track.confirmed) continue;
    track.doubt(dt_s);
    judge(track);
  }
  bodies_.assign(clusters.begin(), clusters.end());
  associate(clusters);
  look_beside(look_for);
  for (Track& track : tracks_) {
    if (!config_.movers || track.known_walker || !track.person().seen || !track.walked()) continue;
    if (!seen_through(track)) continue;
    track.known_walker = true;
    track.weigh(kWalkEvidence);
    judge(track);
  }
  end_tracks(stamp);
  begin_tracks(stamp, clusters);
  list_people();
}

/// The nearest pair first, whether people or not: who walks past a pole must not take the pole's cluster.
void Tracker::associate(std::span<const Cluster> clusters) {
  taken_.assign(clusters.size(), false);
  for (std::size_t c = 0; c < clusters.size(); ++c) taken_[c] = contested(clusters[c]);
  pairs_.clear();
  for (std::uint32_t t = 0; t < tracks_.size(); ++t) {
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
      const Eigen::Vector2d at = clusters[c].centre.cast<double>();
      if (taken_[c] || (at - tracks_[t].person().position).norm() > kFarthest) continue;
      const double distance2 = tracks_[t].distance2(at, kClusterSigma);
      if (distance2 < kGate2) pairs_.push_back({distance2, t, c});
    }
  }
  std::ranges::sort(pairs_, {}, [](const Pair& p) { return std::tuple(p.distance2, p.track, p.cluster); });
  for (const Pair& pair : pairs_) {
    Track& track = tracks_[pair.track];
    if (taken_[pair.cluster] || track.person().seen) continue;
    taken_[pair.cluster] = true;
    track.update(clusters[pair.cluster].centre.cast<double>(), kClusterSigma, static_cast<std::int32_t>(pair.cluster));
    track.sure(track.person().stamp);
  }
}

/// Two people who stand so close that they are one cluster: it is neither's alone.
bool Tracker::contested(const Cluster& cluster) const {
  const auto within = std::ranges::count_if(tracks_, [&](const Track& t) {
    return t.confirmed && (t.person().position - cluster.centre.cast<double>()).norm() < kReach;
  });
  return within > 1 && cluster.extent > kOneBody;
}

/// People without a cluster: they stand beside something, or close together.
void Tracker::look_beside(const LookFor& look_for) {
  std::vector<Eigen::Vector2d> expected;
  for (const Track& track : tracks_)
    if (track.confirmed) expected.push_back(track.person().position);
  for (Track& track : tracks_) {
    const Person& person = track.person();
    if (!track.confirmed || person.seen || person.stamp - track.last_sure() > kUnsure) continue;
    std::vector<Eigen::Vector2d> others;
    std::ranges::copy_if(expected, std::back_inserter(others), [&](const Eigen::Vector2d& other) {
      return other != person.position && (other - person.position).norm() < 2 * kReach;
    });
    const auto found = look_for(person.position, others);
    if (!found) continue;
    track.update(*found, kBesideSigma, static_cast<std::int32_t>(bodies_.size()));
    bodies_.push_back(
        {.centre = person.position.cast<float>(), .ground = person.ground, .top = 0, .extent = 0, .points = 0});
  }
}

/// Nobody stands where an older track is.
void Tracker::end_tracks(Time stamp) {
  const Duration patience = from_seconds(config_.patience_s);
  for (Track& track : tracks_) {
    track.ended = stamp - track.last_seen() > (track.known() ? patience : kHope);
    if (!track.confirmed || track.ended) continue;
    track.ended = std::ranges::any_of(tracks_, [&](const Track& t) {
      return t.confirmed && !t.ended && t.person().id < track.person().id &&
             (t.person().position - track.person().position).norm() < kBody;
    });
  }
  std::erase_if(tracks_, [](const Track& track) { return track.ended; });
}

void Tracker::begin_tracks(Time stamp, std::span<const Cluster> clusters) {
  for (std::size_t c = 0; c < clusters.size() && tracks_.size() < kMostTracks; ++c) {
    if (taken_[c]) continue;
    const Eigen::Vector2d at = clusters[c].centre.cast<double>();
    tracks_.emplace_back(stamp, at, clusters[c].ground, static_cast<std::int32_t>(c));
  }
}

void Tracker::hear(Time stamp, std::span<const Verdict> verdicts, const DetectorTrust& trust) {
  const double seen = std::log(trust.recall / trust.false_share);
  const double missed = std::log((1 - trust.recall) / (1 - trust.false_share));
  for (Track& track : tracks_) {
    const auto step = std::ranges::find(track.steps(), stamp, &Step::stamp);
    if (step == track.steps().end() || step->body < 0) continue;
    const auto body = static_cast<std::size_t>(step->body);
    if (body >= verdicts.size() || verdicts[body] == Verdict::kNothing) continue;
    const bool person = verdicts[body] == Verdict::kPerson;
    if (person) track.sighted();
    if (person) track.sure(stamp);
    track.weigh(person ? seen : missed);
    judge(track);
  }
  list_people();
}

std::vector<std::pair<std::uint32_t, std::size_t>> Tracker::bodies_of_people(Time stamp) const {
  std::vector<std::pair<std::uint32_t, std::size_t>> bodies;
  for (const Track& track : tracks_) {
    const auto step = std::ranges::find(track.steps(), stamp, &Step::stamp);
    if (step != track.steps().end() && step->body >= 0 && track.confirmed)
      bodies.emplace_back(track.person().id, static_cast<std::size_t>(step->body));
  }
  return bodies;
}

void Tracker::weigh(std::uint32_t id, double nats) {
  const auto track = std::ranges::find(tracks_, id, [](const Track& t) { return t.person().id; });
  if (track == tracks_.end()) return;
  track->weigh(nats);
  judge(*track);
  list_people();
}

void Tracker::clear() {
  tracks_.clear();
  people_.clear();
}

void Tracker::judge(Track& track) {
  if (track.evidence() >= config_.confirm) track.confirmed = true;
  if (track.confirmed && track.person().id == 0) track.name(next_id_++);
  if (track.evidence() < kDoubt) track.confirmed = track.reported = false;
}

void Tracker::list_people() {
  people_.clear();
  for (const Track& track : tracks_)
    if (track.confirmed) people_.push_back(track.person());
  std::ranges::sort(people_, {}, &Person::id);
}

std::vector<const Track*> Tracker::take_new() {
  std::vector<const Track*> fresh;
  for (Track& track : tracks_) {
    if (!track.confirmed || track.reported) continue;
    track.reported = true;
    fresh.push_back(&track);
  }
  return fresh;
}

}  // namespace cairn::people
