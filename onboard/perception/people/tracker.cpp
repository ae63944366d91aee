// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace cairn::people {
namespace {

constexpr double kGate2 = 9.21;          // χ² of two directions, 99 %
constexpr double kFarthest = 1.2;        // m from where a track is expected
constexpr double kFarthestHidden = 1.0;  // m from where somebody hidden is expected
constexpr double kBesideSigma = 0.25;    // m: of what look_for finds
constexpr double kBody = 0.35;           // m; nearer together two people cannot be
constexpr double kReach = 0.6;           // m; from the middle of two to each of them

// Evidence, nats.
// Furniture does not come. Of what came upright in six drives, 82 bodies were people and 13 were not, 12 of them
// bushes.
constexpr double kEnterEvidence = 4;
constexpr double kEnterForPictures = 3;  // the same, where nobody is a person without a picture
constexpr double kUprightEvidence = 2;   // it is as high and as wide as a person, where nothing was known
constexpr double kKnownDoubt = 0.3;      // in each scan, of what stood there before
constexpr double kDoubt = 0;             // below, a person is none any more

// Shares of a cluster's points, and its extent, m.
constexpr float kEntered = 0.6F;         // of who comes into free places
constexpr float kEnteredUpright = 0.3F;  // the same, of what is as high and as wide as a person
constexpr float kUnknown = 0.1F;         // of what may have come with the view
constexpr float kLongKnown = 0.5F;       // of what stood there before
constexpr float kMostKnown = 0.3F;       // of who walks
constexpr float kWide = 0.2F;            // edges of walls are thinner

constexpr double kShortWalk = 0.45, kShortWalkTime = 0.45;  // m and s, of who came into free places
constexpr double kFewSteps = 0.3, kFewStepsTime = 0.25;     // m and s, of who did so upright
constexpr Duration kHope = std::chrono::milliseconds(300);  // for what has just been seen first
constexpr Duration kRemembered = std::chrono::seconds(4);   // who is hidden
constexpr int kMisses = 3;                                  // scans that look through where somebody is expected
constexpr Duration kWelcome = std::chrono::seconds(4);      // how long a newcomer stays out of the map unconfirmed
constexpr Duration kUnsure = std::chrono::seconds(3);       // for who stands beside something, and no camera sees

/// Whether it may be somebody who was hidden: it has come. Of legs, little is seen before they are somebody's.
bool may_be_again(const Cluster& seen) { return seen.low ? seen.known < kMostKnown : seen.entered >= kEntered; }

}  // namespace

std::span<const Eigen::Vector2d> Tracker::predict(Time stamp) {
  seeds_.clear();
  for (Track& track : tracks_) {
    track.predict(stamp);
    if (track.known() && !track.hidden) seeds_.push_back(track.person().position);
  }
  return seeds_;
}

void Tracker::step(Time stamp, std::span<const Cluster> clusters, const LookFor& look_for,
                   const SeenThrough& seen_through, const SeenThrough& empty) {
  bodies_.assign(clusters.begin(), clusters.end());
  associate(clusters);
  look_beside(look_for);
  weigh_ways(stamp, clusters, seen_through);
  for (Track& track : tracks_)
    if (track.confirmed && !track.hidden && !track.person().seen && empty(track)) track.miss();
  end_tracks(stamp);
  begin_tracks(stamp, clusters);
  list_people();
}

void Tracker::weigh_ways(Time stamp, std::span<const Cluster> clusters, const SeenThrough& seen_through) {
  for (Track& track : tracks_) {
    const auto body = static_cast<std::size_t>(track.steps().back().body);
    if (!track.person().seen || body >= bodies_.size()) continue;
    const Cluster& seen = bodies_[body];
    if (body < clusters.size()) {
      weigh_places(track, seen);
      if (walks(track, seen, seen_through)) track.walks();
    }
    if (track.confirmed) track.doubt(stamp, seen);
    judge(track);
  }
}

/// What the map knew of the places where a track is now.
void Tracker::weigh_places(Track& track, const Cluster& seen) {
  if (track.confirmed || seen.porous()) return;  // confirmed: what is taken back counts as free
  const bool comes =
      (seen.entered >= kEntered && seen.extent >= kWide) || (seen.entered >= kEnteredUpright && seen.upright);
  if (comes && track.enters()) track.weigh(config_.movers ? kEnterEvidence : kEnterForPictures);
  if (seen.upright && seen.known < kUnknown && track.stands_upright()) track.weigh(kUprightEvidence);
  if (seen.known >= kLongKnown && !track.newcomer()) track.weigh(-kKnownDoubt);
}

bool Tracker::walks(const Track& track, const Cluster& seen, const SeenThrough& seen_through) const {
  if (!config_.movers || track.known_walker() || seen.known > kMostKnown || seen.porous()) return false;
  const bool far_enough = track.newcomer() && track.upright() ? track.walked(kFewSteps, kFewStepsTime)
                          : track.newcomer()                  ? track.walked(kShortWalk, kShortWalkTime)
                                                              : track.walked();
  return far_enough && seen_through(track);
}

/// The nearest pair first, whether people or not: who walks past a pole must not take the pole's cluster.
void Tracker::associate(std::span<const Cluster> clusters) {
  taken_.assign(clusters.size(), false);
  pairs_.clear();
  for (std::uint32_t t = 0; t < tracks_.size(); ++t) {
    if (tracks_[t].hidden) continue;
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
    track.stand_on(clusters[pair.cluster].ground);
    track.sure(track.person().stamp);
  }
  find_again(clusters);
}

/// Whom nobody has seen for a while may be who appears where nobody was.
void Tracker::find_again(std::span<const Cluster> clusters) {
  pairs_.clear();
  for (std::uint32_t t = 0; t < tracks_.size(); ++t) {
    if (!tracks_[t].hidden) continue;
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
      if (taken_[c] || !may_be_again(clusters[c])) continue;
      const double away = (clusters[c].centre.cast<double>() - tracks_[t].person().position).norm();
      if (away < kFarthestHidden) pairs_.push_back({away, t, c});
    }
  }
  std::ranges::sort(pairs_, {}, [](const Pair& p) { return std::tuple(p.distance2, p.track, p.cluster); });
  for (const Pair& pair : pairs_) {
    Track& track = tracks_[pair.track];
    if (taken_[pair.cluster] || !track.hidden) continue;
    taken_[pair.cluster] = true;
    track.hidden = false;
    track.restart(clusters[pair.cluster].centre.cast<double>(), static_cast<std::int32_t>(pair.cluster));
    track.stand_on(clusters[pair.cluster].ground);
    track.sure(track.person().stamp);
  }
}

/// People without a cluster: they stand beside something, or close together.
void Tracker::look_beside(const LookFor& look_for) {
  std::vector<Eigen::Vector2d> expected;
  for (const Track& track : tracks_)
    if (track.confirmed && !track.hidden) expected.push_back(track.person().position);
  for (Track& track : tracks_) {
    const Person& person = track.person();
    if (track.hidden || !(track.confirmed || person.sightings > 0) || person.seen ||
        person.stamp - track.last_sure() > kUnsure)
      continue;
    std::vector<Eigen::Vector2d> others;
    std::ranges::copy_if(expected, std::back_inserter(others), [&](const Eigen::Vector2d& other) {
      return other != person.position && (other - person.position).norm() < 2 * kReach;
    });
    const auto found = look_for(person.position, others);
    if (!found) continue;
    track.update(found->position, kBesideSigma, static_cast<std::int32_t>(bodies_.size()));
    track.stand_on(found->ground);
    bodies_.push_back({.centre = person.position.cast<float>(), .ground = person.ground, .passed = found->passed});
  }
}

/// Nobody stands where an older track is.
void Tracker::end_tracks(Time stamp) {
  const Duration patience = from_seconds(config_.patience_s);
  for (Track& track : tracks_) {
    const Duration unseen = stamp - track.last_seen();
    track.hidden = track.confirmed && (unseen > patience || track.misses() >= kMisses);
    track.ended = unseen > (track.hidden ? kRemembered : track.known() ? patience : kHope);
    if (!track.confirmed || track.ended || track.hidden) continue;
    track.ended = std::ranges::any_of(tracks_, [&](const Track& t) {
      return t.confirmed && !t.ended && !t.hidden && t.person().id < track.person().id &&
             (t.person().position - track.person().position).norm() < kBody;
    });
  }
  std::erase_if(tracks_, [](const Track& track) { return track.ended; });
}

/// Legs alone begin a track only where they came: there is much below desks.
void Tracker::begin_tracks(Time stamp, std::span<const Cluster> clusters) {
  for (std::size_t c = 0; c < clusters.size() && tracks_.size() < kMostTracks; ++c) {
    if (taken_[c] || (clusters[c].low && clusters[c].entered < kEntered)) continue;
    const Eigen::Vector2d at = clusters[c].centre.cast<double>();
    Track& track = tracks_.emplace_back(stamp, at, clusters[c].ground, static_cast<std::int32_t>(c));
    weigh_places(track, clusters[c]);
  }
}

void Tracker::hear(Time stamp, std::span<const Answer> answers, const DetectorTrust& trust) {
  for (Track& track : tracks_) {
    const auto step = std::ranges::find(track.steps(), stamp, &Step::stamp);
    if (step == track.steps().end() || step->body < 0) continue;
    const auto body = static_cast<std::size_t>(step->body);
    if (body >= answers.size() || answers[body].verdict == Verdict::kNothing) continue;
    const bool person = answers[body].verdict == Verdict::kPerson;
    if (person) track.sighted(stamp);
    track.weigh(person ? trust.of_box(answers[body].score) : trust.of_silence(answers[body].distance));
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

void Tracker::hear_apart(Time stamp, Time now, std::span<const Lifted> lifted, const DetectorTrust& trust) {
  for (const Lifted& found : lifted) {
    Track* nearest = nullptr;
    double least = kReach;
    for (Track& track : tracks_) {
      const auto step = std::ranges::find(track.steps(), stamp, &Step::stamp);
      if (step == track.steps().end()) continue;
      const double distance = (step->position - found.position).norm();
      if (distance >= least) continue;
      least = distance;
      nearest = &track;
    }
    if (nearest == nullptr) {
      if (tracks_.size() >= kMostTracks) continue;
      nearest = &tracks_.emplace_back(stamp, found.position, found.ground, -1);
      if (now > stamp) nearest->predict(now);
    }
    nearest->sighted(stamp);
    nearest->weigh(trust.of_box(found.score));
    judge(*nearest);
  }
  list_people();
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
  newcomers_.clear();
}

void Tracker::judge(Track& track) {
  if (track.evidence() >= config_.confirm) track.confirmed = true;
  if (track.confirmed && track.person().id == 0) track.name(next_id_++);
  if (track.evidence() < kDoubt) track.confirmed = track.reported = false;
}

void Tracker::list_people() {
  people_.clear();
  newcomers_.clear();
  for (const Track& track : tracks_) {
    if (track.confirmed && !track.hidden) people_.push_back(track.person());
    if (!track.confirmed && track.newcomer() && track.age() < kWelcome) newcomers_.push_back(track.person());
  }
  std::ranges::sort(people_, {}, &Person::id);
}

std::vector<const Track*> Tracker::take_new() {
  std::vector<const Track*> fresh;
  for (Track& track : tracks_) {
    if (!track.confirmed || track.reported || track.hidden) continue;
    track.reported = true;
    fresh.push_back(&track);
  }
  return fresh;
}

}  // namespace cairn::people
