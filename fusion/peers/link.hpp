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
#include "hal/time.hpp"

namespace cairn::peers {

/// What a robot knows about one that it hears: whether it is there, its clock, what it knows of everyone, and what was
/// sent to it lately.
struct Link {
  /// What the peer knows of one robot, by its last digest.
  struct Known {
    Epoch epoch = 0;
    bool direct = false;
    VersionSet versions;
  };
  std::string name;
  Time last_heard = Time::min();
  Epoch epoch = 0;                       ///< by its last hello
  Version newest = 0;                    ///< that it has said, by its last hello
  Hello::Echo echo{0, Time::min(), {}};  ///< its last hello, to be sent back; `age` is not kept here
  Time echo_heard{};
  ClockOffset clock;
  Conduct conduct;
  bool told = false;                                      ///< a digest has come
  std::map<RobotId, Known> known;                         ///< not of more robots than a digest has
  std::map<std::pair<RobotId, Version>, Time> in_flight;  ///< items sent lately, of which no digest has told yet
  std::set<RobotId> owed;                                 ///< of whom more is known than it was told
  Time next_status = Time::min(), next_digest = Time::min(), next_full = Time::min();  ///< when these are due
  Time last_items = Time::min();                                                       ///< sent to it
  double loss = 0;  ///< share of the items sent lately that did not arrive
  void note_fate(bool arrived) { loss += 0.02 * ((arrived ? 0 : 1) - loss); }
  std::uint64_t received_bytes = 0, sent_bytes = 0, received_items = 0, sent_items = 0;
  std::uint64_t repeated_items = 0;   ///< received, and known already
  std::uint64_t refused = 0;          ///< datagrams that cannot be
  std::uint64_t unsupported = 0;      ///< of these, of another format
  std::uint32_t voxel_um = 0;         ///< by its last hello; 0 before
  std::optional<Hello::Place> place;  ///< by its last hello, in its odom frame
};

}  // namespace cairn::peers
