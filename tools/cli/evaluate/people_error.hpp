// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "hal/time.hpp"

namespace cairn::cli {

/// People and tracks at the time of one scan, in one frame.
struct PeopleFrame {
  struct Person {
    std::int64_t id = 0;
    Eigen::Vector2d position{0, 0};  ///< metres
    bool counts = true;              ///< false: neither missed nor found; a track at this person is not false
  };
  struct Track {
    std::int64_t id = 0;
    Eigen::Vector2d position{0, 0};  ///< metres
    bool counts = true;              ///< false: it is not false if nobody is there
  };
  Time stamp{};
  std::vector<Person> people;
  std::vector<Track> tracks;
};

/// What one person or track counted as in a frame.
struct PeopleDetail {
  Time stamp{};
  const char* what = "";           ///< found, missed, switched (found by another track than before), or false
  std::int64_t person = -1;        ///< -1: nobody
  std::int64_t track = -1;         ///< -1: none
  Eigen::Vector2d position{0, 0};  ///< of the person; of a false track, its own
};

/// Figures of `cairn evaluate people`, over all frames.
struct PeopleError {
  std::uint64_t people = 0;           ///< persons that count, each once a frame
  std::uint64_t found = 0;            ///< of these, with a track
  std::uint64_t false_tracks = 0;     ///< tracks that count at nobody, each once a frame
  std::uint64_t id_switches = 0;      ///< persons who were found by another track than before
  double squared_m2 = 0;              ///< sum over `found`: squared distance of track and person
  std::vector<PeopleDetail> details;  ///< in the order of time
  std::vector<double> ghosts_s;       ///< how long each track was at nobody, each time, in rising order

  [[nodiscard]] std::optional<double> precision() const;  ///< found / (found + false_tracks)
  [[nodiscard]] std::optional<double> recall() const;     ///< found / people
  [[nodiscard]] std::optional<double> mota() const;       ///< 1 − (missed + false_tracks + id_switches) / people
  [[nodiscard]] std::optional<double> position_rmse_m() const;
  /// The smallest length of `ghosts_s` that 95 % of them do not exceed; 0 where there are none.
  [[nodiscard]] double ghost_p95_s() const;
};

/// CLEAR MOT (Bernardin and Stiefelhagen, "Evaluating Multiple Object Tracking Performance", EURASIP 2008). A person
/// keeps their track while both are less than `gate_m` apart. Then the nearest pairs are taken first, up to `gate_m`.
/// A person who did not count for longer than kAbsent is somebody new.
class PeopleJudge {
 public:
  static constexpr Duration kAbsent = std::chrono::seconds(2);

  explicit PeopleJudge(double gate_m) : gate_m_(gate_m) {}

  /// Frames come in the order of time.
  void add(const PeopleFrame& frame);
  /// After the last frame. `period`: from scan to scan.
  [[nodiscard]] PeopleError finish(Duration period) const;

 private:
  struct Known {
    std::int64_t track;
    Time counted;  // when the person was last found by it, and counted
  };
  struct Spell {
    Time first, last;
  };
  using Pairs = std::map<std::size_t, std::size_t>;  // index of the person to that of the track

  [[nodiscard]] Pairs pair(const PeopleFrame& frame) const;
  void count(const PeopleFrame& frame, const Pairs& pairs);
  void note_found(const PeopleFrame::Person& person, const PeopleFrame::Track& track, Time stamp);
  void note_ghosts(const PeopleFrame& frame, const std::vector<bool>& at_somebody);

  double gate_m_;
  PeopleError error_;
  std::map<std::int64_t, std::int64_t> partner_;  // person to track, of the last pair of either
  std::map<std::int64_t, Known> found_by_;        // person to the track that found them while they counted
  std::map<std::int64_t, Spell> ghosts_;          // tracks that are at nobody now
  std::vector<Spell> past_ghosts_;
};

}  // namespace cairn::cli
