// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_error.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace cairn::cli {
namespace {

std::optional<double> share_of(double part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return part / static_cast<double>(whole);
}

}  // namespace

std::optional<double> PeopleError::precision() const {
  return share_of(static_cast<double>(found), found + false_tracks);
}

std::optional<double> PeopleError::recall() const { return share_of(static_cast<double>(found), people); }

std::optional<double> PeopleError::mota() const {
  return share_of(static_cast<double>(found) - static_cast<double>(false_tracks) - static_cast<double>(id_switches),
                  people);
}

std::optional<double> PeopleError::position_rmse_m() const {
  const auto mean = share_of(squared_m2, found);
  if (!mean) return std::nullopt;
  return std::sqrt(*mean);
}

double PeopleError::ghost_p95_s() const {
  if (ghosts_s.empty()) return 0;
  const std::size_t n = ghosts_s.size();
  return ghosts_s[(95 * n + 99) / 100 - 1];
}

PeopleJudge::Pairs PeopleJudge::pair(const PeopleFrame& frame) const {
  // Former pairs come first, then by distance; numbers make the order the same everywhere.
  using Candidate = std::tuple<bool, double, std::size_t, std::size_t>;
  std::vector<Candidate> candidates;
  for (std::size_t p = 0; p < frame.people.size(); ++p) {
    const auto former = partner_.find(frame.people[p].id);
    for (std::size_t t = 0; t < frame.tracks.size(); ++t) {
      const double d = (frame.people[p].position - frame.tracks[t].position).norm();
      if (!(d < gate_m_)) continue;
      const bool known = former != partner_.end() && former->second == frame.tracks[t].id;
      candidates.emplace_back(!known, d, p, t);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  Pairs pairs;
  std::set<std::size_t> taken;
  for (const auto& [is_new, d, p, t] : candidates)
    if (!pairs.contains(p) && taken.insert(t).second) pairs[p] = t;
  return pairs;
}

void PeopleJudge::note_found(const PeopleFrame::Person& person, const PeopleFrame::Track& track, Time stamp) {
  ++error_.found;
  error_.squared_m2 += (person.position - track.position).squaredNorm();
  const auto known = found_by_.find(person.id);
  const bool switched =
      known != found_by_.end() && known->second.track != track.id && stamp - known->second.counted <= kAbsent;
  if (switched) ++error_.id_switches;
  error_.details.push_back({stamp, switched ? "switched" : "found", person.id, track.id, person.position});
  found_by_.insert_or_assign(person.id, Known{track.id, stamp});
}

void PeopleJudge::note_ghosts(const PeopleFrame& frame, const std::vector<bool>& at_somebody) {
  std::map<std::int64_t, Spell> now;
  for (std::size_t t = 0; t < frame.tracks.size(); ++t) {
    if (at_somebody[t] || !frame.tracks[t].counts) continue;
    ++error_.false_tracks;
    error_.details.push_back({frame.stamp, "false", -1, frame.tracks[t].id, frame.tracks[t].position});
    const auto before = ghosts_.find(frame.tracks[t].id);
    now[frame.tracks[t].id] = {before == ghosts_.end() ? frame.stamp : before->second.first, frame.stamp};
  }
  for (const auto& [track, spell] : ghosts_)
    if (!now.contains(track)) past_ghosts_.push_back(spell);
  ghosts_ = std::move(now);
}

void PeopleJudge::count(const PeopleFrame& frame, const Pairs& pairs) {
  std::vector<bool> at_somebody(frame.tracks.size(), false);
  for (const auto& [p, t] : pairs) {
    const PeopleFrame::Person& person = frame.people[p];
    at_somebody[t] = true;
    const std::int64_t track = frame.tracks[t].id;
    std::erase_if(partner_, [track](const auto& other) { return other.second == track; });
    partner_[person.id] = track;
    if (person.counts) note_found(person, frame.tracks[t], frame.stamp);
  }
  for (std::size_t p = 0; p < frame.people.size(); ++p) {
    if (!frame.people[p].counts) continue;
    ++error_.people;
    if (!pairs.contains(p))
      error_.details.push_back({frame.stamp, "missed", frame.people[p].id, -1, frame.people[p].position});
    // Somebody who is there and not found keeps the track that they had.
    const auto known = found_by_.find(frame.people[p].id);
    if (known != found_by_.end() && frame.stamp - known->second.counted <= kAbsent) known->second.counted = frame.stamp;
  }
  note_ghosts(frame, at_somebody);
}

void PeopleJudge::add(const PeopleFrame& frame) { count(frame, pair(frame)); }

PeopleError PeopleJudge::finish(Duration period) const {
  PeopleError error = error_;
  std::vector<Spell> spells = past_ghosts_;
  for (const auto& [track, spell] : ghosts_) spells.push_back(spell);
  for (const Spell& spell : spells) error.ghosts_s.push_back(to_seconds(spell.last - spell.first + period));
  std::sort(error.ghosts_s.begin(), error.ghosts_s.end());
  return error;
}

}  // namespace cairn::cli
