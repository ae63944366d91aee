// SPDX-License-Identifier: Apache-2.0
#include "tools/team/supervisor.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>

namespace cairn::team_run {
namespace {

class Supervisor {
 public:
  Supervisor(const Supervision& what, Network& network, const Clock& clock)
      : what_(what), network_(network), clock_(clock), begin_(clock.now()) {
    end_.robots.resize(what.robots.size());
  }

  Result<TeamEnd> run() {
    if (const auto started = start(); !started) return started.error();
    while (!all_cores_ended()) {
      move_packets();
      kill_what_is_due();
      if (const auto restarted = restart_dead_peers(); !restarted) return restarted.error();
      look_after_the_end();
      if (what_.progress) what_.progress(age());
    }
    end_peers();
    end_.took = age();
    return end_;
  }

 private:
  [[nodiscard]] Duration age() const { return clock_.now() - begin_; }

  Result<void> start() {
    for (const RobotProcesses& robot : what_.robots) {
      auto core = Process::start(robot.core);
      if (!core) return core.error();
      cores_.push_back(*std::move(core));
    }
    for (const RobotProcesses& robot : what_.robots) {
      auto peers = Process::start(robot.peers);
      if (!peers) return peers.error();
      peers_.push_back(*std::move(peers));
      started_.push_back(clock_.now());
    }
    return {};
  }

  /// Waits until a packet is there or due. Deaths are noticed by looking, so it is never long.
  void move_packets() {
    constexpr Duration kMost = std::chrono::milliseconds(20);
    const Time now = clock_.now();
    const Duration next = std::clamp(network_.radio().next().value_or(now + kMost) - now, Duration{}, kMost);
    const timespec timeout{0, static_cast<long>(next.count())};
    std::vector<pollfd> waits;
    network_.add_waits(waits);
    (void)::ppoll(waits.data(), waits.size(), &timeout, nullptr);
    network_.pump(clock_.now());
  }

  void kill_what_is_due() {
    for (; next_kill_ < what_.kills.size() && what_.kills[next_kill_].after <= age(); ++next_kill_) {
      const Index robot = what_.kills[next_kill_].robot;
      peers_[robot].signal(SIGKILL);
      ++end_.robots[robot].kills;
      awaited_[robot] = true;
    }
  }

  Result<void> restart_dead_peers() {
    constexpr Duration kLeastLife = std::chrono::milliseconds(500);  // one that cannot live is not started in a loop
    for (Index i = 0; i < peers_.size(); ++i) {
      const auto code = peers_[i].ended();
      if (!code || (!awaited_[i] && clock_.now() - started_[i] < kLeastLife)) continue;
      if (!awaited_[i]) say(fmt::format("{}: its peer process died ({}) and is started again", name(i), *code));
      auto again = Process::start(what_.robots[i].peers);
      if (!again) return again.error();
      peers_[i] = *std::move(again);
      started_[i] = clock_.now();
      awaited_[i] = false;
      ++end_.robots[i].restarts;
    }
    return {};
  }

  bool all_cores_ended() {
    bool all = true;
    for (Index i = 0; i < cores_.size(); ++i) {
      const auto code = cores_[i].ended();
      all = all && code;
      if (!code || end_.robots[i].exit_code == *code) continue;
      end_.robots[i].exit_code = *code;
      if (*code == 0 || asked_at_) continue;
      end_.failed = i;
      ask_to_end(fmt::format("{}: its core failed ({})", name(i), *code));
    }
    return all;
  }

  void look_after_the_end() {
    if (!asked_at_ && what_.stop && what_.stop()) ask_to_end("asked to end");
    if (!asked_at_ && age() > what_.longest) ask_to_end("the cores do not end by themselves");
    if (asked_at_ && clock_.now() - *asked_at_ > what_.grace)
      for (Process& core : cores_) core.kill();
  }

  void ask_to_end(const std::string& why) {
    say(why);
    asked_at_ = clock_.now();
    end_.stopped = true;
    for (const Process& core : cores_) core.signal(SIGTERM);
  }

  void end_peers() {
    for (const Process& peers : peers_) peers.signal(SIGTERM);
    const Time last = clock_.now() + std::chrono::seconds(2);
    while (clock_.now() < last && std::ranges::any_of(peers_, [](Process& p) { return !p.ended(); })) move_packets();
    peers_.clear();
  }

  [[nodiscard]] const std::string& name(Index robot) const { return what_.robots[robot].name; }
  void say(const std::string& line) const {
    if (what_.say) what_.say(line);
  }

  const Supervision& what_;
  Network& network_;
  const Clock& clock_;
  Time begin_;
  std::vector<Process> cores_, peers_;
  std::vector<Time> started_;
  std::map<Index, bool> awaited_;  // the death of a peer process that was killed
  std::size_t next_kill_ = 0;
  std::optional<Time> asked_at_;
  TeamEnd end_;
};

}  // namespace

Result<TeamEnd> supervise(const Supervision& supervision, Network& network, const Clock& clock) {
  return Supervisor(supervision, network, clock).run();
}

}  // namespace cairn::team_run
