// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "fusion/peers/clock_offset.hpp"
#include "fusion/peers/conduct.hpp"
#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/exchange_config.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// What a robot knows about a peer that it hears: whether it is there, its clock, what it knows of each
/// robot, and what was sent to it lately. Times are of the robot's own clock.
struct Link {
  /// What the peer knows of one robot, by its last digest.
  struct Known {
    Epoch epoch = 0;
    bool direct = false;  ///< the peer hears that robot itself
    VersionSet versions;
  };
  std::string name;
  Time last_heard = Time::min();
  Epoch epoch = 0;                       ///< by its last hello
  Version newest = 0;                    ///< that it has published, by its last hello
  Hello::Echo echo{0, Time::min(), {}};  ///< its last hello, to be sent back; `age` is not kept here
  Time echo_heard{};
  ClockOffset clock;
  Conduct conduct;
  bool told = false;                                      ///< a digest has come
  std::map<RobotId, Known> known;                         ///< of at most Digest::kMaxLayers robots
  std::map<std::pair<RobotId, Version>, Time> in_flight;  ///< items sent that no digest has told of yet, and when
  std::set<RobotId> owed;                                 ///< robots with news that the peer was not told of
  Time next_status = Time::min(), next_digest = Time::min(), next_full = Time::min();  ///< when these are due
  Time last_items = Time::min();                                                       ///< sent to it
  double loss = 0;  ///< share of the items sent lately that did not arrive, 0…1
  std::uint64_t received_bytes = 0, sent_bytes = 0, received_items = 0, sent_items = 0;
  std::uint64_t repeated_items = 0;   ///< received, and known already
  std::uint64_t refused = 0;          ///< malformed datagrams
  std::uint64_t unsupported = 0;      ///< of these, those of another format
  std::uint32_t voxel_um = 0;         ///< by its last hello; 0 before
  std::optional<Hello::Place> place;  ///< by its last hello, in its odom frame
  /// Where it is, and the people around it.
  struct Heard {
    Bodies bodies;  ///< in its odom frame
    Time seen{};    ///< when they were there
  };
  std::optional<Heard> bodies;          ///< the newest
  Time bodies_sent = Time::min();       ///< stamp of those that were sent to it last
  std::uint64_t sent_bodies_bytes = 0;  ///< of all that were sent to it

  /// Takes in the peer's hello. `self`: this robot. False if it is late: a newer hello has come before.
  bool take(const Hello& hello, RobotId self, Time now);
  /// Takes in where it and people are, if that is newer than what is known.
  void take(const Bodies& heard, Time now);
  /// Takes in what the peer knows.
  void take(const Digest& digest);
  /// Items in flight that the digest tells of have arrived. Those that were sent longer than `round_trip`
  /// ago, and should be in it, are lost.
  void settle_in_flight(const Digest& digest, Duration round_trip, Time now);
  /// Items in flight that were sent longer than `patience` ago are sent again. `lost`: they count as lost.
  void give_up(Duration patience, bool lost, Time now);
  /// How long a datagram and its answer take at most.
  [[nodiscard]] Duration round_trip(const ExchangeConfig& config) const;

 private:
  void note_fate(bool arrived);
};

}  // namespace cairn::peers
