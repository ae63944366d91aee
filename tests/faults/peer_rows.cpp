// SPDX-License-Identifier: Apache-2.0
// Peers and the network between them: three robots, with clocks an hour apart that drift, over an emulated link.
#include "tests/faults/campaign.hpp"
#include "tests/fusion/team/fleet/fleet.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;
using fleet::Fleet;
using fleet::LinkQuality;
using fleet::RobotId;

constexpr RobotId kRobots = 3;
constexpr std::size_t kBytesPerSecond = 16000;
constexpr LinkQuality kGood{}, kLossy{0.2}, kShuffled{0.1, 0.05, 0, 20ms, 300ms}, kReplaying{0.1, 0, 0.1, 20ms, 200ms};
constexpr Duration kLong = 120s;  // nothing takes so long; a measurement that gives up shows in its bound

/// Three robots that know each other and one map. `bad`: what the link is like from then on.
class Rig {
 public:
  explicit Rig(const LinkQuality& bad = kGood) : fleet(kRobots, kBytesPerSecond, kGood, 1) {
    fleet.set_slice(100, Fleet::kTick);
    explore(5s);
    (void)until([this] { return fleet.agrees(); });
    fleet.network.set_quality(bad);
  }
  void explore(Duration length) {
    for (const Time end = fleet.now() + length; fleet.now() < end;) {
      for (RobotId id = 1; id <= kRobots; ++id) fleet.observe(id, 2);
      fleet.run_until(fleet.now() + 500ms);
    }
  }
  template <class Condition>
  Duration until(Condition met) {
    const Time from = fleet.now();
    while (!met() && fleet.now() < from + kLong) fleet.step();
    return fleet.now() - from;
  }
  [[nodiscard]] bool hears(RobotId id, RobotId other) { return fleet.hears(id, other); }
  /// Everyone knows the same, and holds the same map of all three.
  [[nodiscard]] bool one_map() const {
    return fleet.agrees() && fleet.maps().size() == 1 && fleet.team(1).poses().T_team_odom.size() == kRobots;
  }
  /// How long it takes now until all agree, and whether they hold one map then.
  void settle(Measured& m) {
    m.recover = until([this] { return fleet.agrees(); });
    m.held = m.held && one_map();
  }

  Fleet fleet;
};

Measured vanishes() {
  Rig rig;
  Measured m;
  const auto known = rig.fleet.robot(1).layers().at(3).holding.items().size();
  rig.fleet.crash(3);
  m.detect = rig.until([&] { return !rig.hears(1, 3); });
  rig.explore(20s);
  m.held = known > 0 && rig.fleet.robot(1).layers().at(3).holding.items().size() == known &&
           rig.fleet.team(1).poses().T_team_odom.contains(3);
  rig.fleet.start(3, 2);
  m.recover = rig.until([&] { return rig.hears(1, 3); });
  return m;
}

/// `cut` separates robot 3 from the others, `heal` brings it back.
template <class Cut, class Heal>
Measured partition(Cut cut, Heal heal) {
  Rig rig;
  Measured m;
  cut(rig.fleet.network);
  m.detect = rig.until([&] { return !rig.hears(1, 3); });
  rig.explore(60s);
  heal(rig.fleet.network);
  rig.settle(m);
  return m;
}

Measured whole_partition() {
  return partition([](auto& network) { network.put(3, 1); }, [](auto& network) { network.put(3, 0); });
}

Measured one_way() {
  return partition([](auto& network) { network.mute(3, true); }, [](auto& network) { network.mute(3, false); });
}

Measured flapping() {
  Rig rig;
  Measured m;
  for (int i = 0; i < 10; ++i) {
    rig.fleet.network.put(3, i % 2 == 0 ? 1 : 0);
    rig.explore(3s);
  }
  rig.fleet.network.put(3, 0);
  rig.settle(m);
  return m;
}

Measured rejoins() {
  Rig rig;
  Measured m;
  const auto before = rig.fleet.robot(1).layers().at(3).epoch;
  rig.fleet.crash(3);
  rig.fleet.run_until(rig.fleet.now() + 5s);
  rig.fleet.start(3, 2);
  m.detect = rig.until([&] { return rig.fleet.robot(1).layers().at(3).epoch > before; });
  m.held = rig.fleet.robot(1).layers().at(3).holding.items().size() < 10;  // nothing of the old map is left
  rig.explore(5s);
  rig.settle(m);
  return m;
}

Measured over(const LinkQuality& quality) {
  Rig rig(quality);
  Measured m;
  rig.explore(30s);
  rig.settle(m);
  return m;
}

/// A peer that sends garbage ten times a second for two seconds, between hellos that are right.
Measured malformed() {
  team::TeamConfig config;
  config.id = 1;
  team::Team team(config, peers::Epoch{1} << 32U);
  Time now{1000s};
  const auto hello = [&] {
    return peers::encode({2, peers::Hello{peers::Epoch{1} << 32U, 0, now, "second", {}, 200'000}, {}, {}}).bytes;
  };
  const auto refused = [&] {
    const auto taken = team.receive(hello(), now);
    return !taken && taken.error().code == Errc::kLinkDown;
  };
  Measured m;
  const Time begin = now;
  for (; now < begin + 2s; now += 100ms) {
    auto garbage = hello();
    garbage.resize(20);
    (void)team.receive(garbage, now);
    if (!m.detect && refused()) m.detect = now - begin;
  }
  const Time end = now;
  while (refused() && now < end + kLong) now += 1s;
  m.recover = now - end;
  m.held = team.exchange().layers().at(1).holding.items().empty();
  return m;
}

Row shown_by(const char* id, const char* fault, const char* requirement, const char* test) {
  return {id, fault, requirement, 0ms, 0ms, safety::Mode::kNormal, test};
}

/// Of peers that vanish or come again, and of what a network does to their datagrams.
std::vector<Row> link_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal;
  return {
      {"P1", "a peer vanishes", "It counts as lost after its lease. Its map and its pose are kept.", 3600ms, 2s, N, "",
       vanishes},
      {"P2", "partition for a minute",
       "Each side goes on. Afterwards both have the same data and the same map, to the byte.", 3600ms, 20s, N, "",
       whole_partition},
      {"P3", "partition in one direction", "As for P2.", 3600ms, 20s, N, "", one_way},
      {"P4", "a link that comes and goes every 3 s", "As for P2.", 0ms, 20s, N, "", flapping},
      {"P5", "a robot rejoins with a new map", "The new epoch voids its old map at once, on every robot.", 3s, 10s, N,
       "", rejoins},
      shown_by("P6", "a wrong relative pose",
               "A claim that closes no loop is left out. The map then has its earlier bytes.",
               "team/TeamGraph.AClaimThatClosesNoLoopIsLeftOut"),
      {"P7", "malformed datagrams", "They are refused whole. The tenth in a minute bans the sender for a minute.",
       1500ms, 65s, N, "", malformed},
      shown_by("P8", "a peer sends as many tiles of the worst kind as it can",
               "At most 64 MiB are kept for a robot, derived data included.",
               "team/ItemMemory.ALiarsCheckerboardsStayWithinWhatIsKeptOfARobot"),
      {"P9", "10 % of the datagrams come again, up to a minute later", "All robots have the same map, to the byte.",
       0ms, 10s, N, "", [] { return over(kReplaying); }},
      {"P10", "20 % loss", "Every tile arrives. All robots have the same map, to the byte.", 0ms, 10s, N, "",
       [] { return over(kLossy); }},
      {"P11", "300 ms jitter, 10 % loss, 5 % repeated", "As for P10.", 0ms, 10s, N, "", [] { return over(kShuffled); }},
      {"P12", "clocks that are hours apart and drift by 50 ppm",
       "No decision depends on clocks. Rows P1 to P5 and P9 to P11 use such clocks too.", 0ms, 10s, N, "",
       [] { return over(kGood); }},
  };
}

/// Of the peer process, and of who is listened to.
std::vector<Row> peer_process_rows() {
  return {
      shown_by("P13", "a slow link", "Traffic at the interface stays below the cap in each second, discovery included.",
               "peer_process/UdpCap.NoSecondIsAboveTheCapAtTheInterface"),
      shown_by("P14", "more robots than the limit", "Further robots are refused. Memory stays bounded.",
               "peers/Exchange.ListensToSoManyRobotsAndNoMore"),
      shown_by("P15", "the peer process is killed", "It is started again and goes on. The core does not wait for it.",
               "peer_process/PeerProcess.CarriesDatagramsAndComesBackAfterBeingKilled"),
      shown_by("P16", "the peer process dies again and again in a run",
               "At the end both robots know each other's map. The run can be repeated to the bit.",
               "app/TeamRun.IsRepeatedToTheBitThoughThePeerProcessDies"),
      shown_by("P17", "a peer of another version, or with another voxel size",
               "Its data is not used. `cairn doctor --peer` says why.",
               "team/TeamStanding.MapsOfOtherVoxelsAreNotExchanged"),
      shown_by("P18", "a profile with a wrong start pose",
               "The maps contradict it, and it is taken back. `cairn doctor --peer` says so.",
               "team/TeamDeployment.AnExactButWrongOneIsTakenBack"),
      shown_by("P21", "malformed RTPS packets at any rate",
               "At most two lines of a kind are logged in a minute. The others are counted.",
               "peer_process/PeerProcess.MalformedPacketsDoNotFillTheLog"),
      shown_by("P24", "SIGTERM to the peer process at a cap of 60 B/s",
               "It ends, without waiting for the network's threads.",
               "peer_process/PeerProcess.EndsWhenItIsToldToThoughItsCapIsTiny"),
  };
}

/// Of what is wrong in a map, or in where it lies.
std::vector<Row> trust_rows() {
  return {
      shown_by("P25", "a peer lies about occupancy: a phantom wall, or an erased one",
               "A planner's view never lets a peer overrule what the robot saw itself.",
               "client/PlannerViewTest.WhatTheRobotSawItselfIsNeverOverruled"),
      shown_by("P26", "odometry is wrong and does not know it: scans contradict the robot's own map",
               "Nothing of the map is shared until scans agree with it again, for 3 s at least. What was mapped in the "
               "meantime is not shared as it is. Another submap begins, which the team may move. An event says so.",
               "team/TeamDoubt.ScansThatContradictTheMapAreHeldBackAndANewSubmapFollows"),
      shown_by("P27", "odometry was lost and has found the map again",
               "The team is told nothing for 3 s. If scans then agree with the map, all of it is shared.",
               "peers/SubmapCheck.LostOdometryIsADoubtForAWhileAfterwards"),
      shown_by("P28", "robots were merged in a wrong place, and a person or satellites say where they are",
               "They separate at once. Maps do not overrule it. They merge again where maps confirm it.",
               "team/FullTeamPlacedByPerson.SeparatesRobotsUntilTheMapsConfirmIt"),
  };
}

}  // namespace

std::vector<Row> peer_rows() {
  std::vector<Row> all = link_rows();
  for (const auto& rows : {peer_process_rows(), trust_rows()}) all.insert(all.end(), rows.begin(), rows.end());
  return all;
}

}  // namespace cairn::faults
