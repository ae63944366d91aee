// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/stream/people_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "hal/clock.hpp"
#include "tools/cli/stream/core_stream.hpp"

namespace cairn::cli {
namespace {

using client::PeopleMessage;

constexpr Duration kWaitForPeople = std::chrono::seconds(5);

struct PeopleArguments {
  std::filesystem::path socket;
  bool json = false, team = false;
  std::optional<double> seconds;
};

nlohmann::ordered_json json_of(const PeopleMessage::Person& p) {
  return {{"id", p.id},
          {"xyz", std::vector<double>{p.position_odom.x(), p.position_odom.y(), p.position_odom.z()}},
          {"velocity", std::vector<double>{p.velocity_odom.x(), p.velocity_odom.y()}},
          {"covariance_xx_xy_yy", std::vector<double>{p.covariance(0, 0), p.covariance(0, 1), p.covariance(1, 1)}},
          {"sightings", p.sightings},
          {"seen", p.seen}};
}

std::string json_of(const PeopleMessage& message) {
  nlohmann::ordered_json people = nlohmann::ordered_json::array();
  for (const PeopleMessage::Person& person : message.people) people.push_back(json_of(person));
  return nlohmann::ordered_json{{"stamp_ns", message.stamp.time_since_epoch().count()},
                                {"epoch", message.epoch},
                                {"robot", message.robot},
                                {"people", people}}
      .dump();
}

std::string text_of(const PeopleMessage& message) {
  const std::string whose = message.robot == 0 ? "" : fmt::format("robot {}: ", message.robot);
  std::string text = fmt::format("{:.3f} s  {}{} people", to_seconds(message.stamp), whose, message.people.size());
  for (const PeopleMessage::Person& p : message.people)
    text += fmt::format("  #{} at {:.2f} {:.2f} m, {:.1f} m/s{}", p.id, p.position_odom.x(), p.position_odom.y(),
                        p.velocity_odom.norm(), p.seen ? "" : " (hidden)");
  return text;
}

/// Prints what comes and knows when it is enough.
class PeoplePrinter {
 public:
  explicit PeoplePrinter(const PeopleArguments& arguments) : a_(arguments), start_(LiveClock().now()) {}

  Result<bool> take(const client::StreamMessage& message) {
    const auto* people = std::get_if<PeopleMessage>(&message);
    if (people == nullptr) return true;
    ++messages_;
    std::cout << (a_.json ? json_of(*people) : text_of(*people)) << std::endl;
    return static_cast<bool>(std::cout);  // whoever read is gone
  }
  Result<bool> idle() {
    const Duration passed = LiveClock().now() - start_;
    if (messages_ == 0 && !complained_ && passed > kWaitForPeople) {
      complained_ = true;
      std::cerr << "cairn: nothing yet: the core follows no people (perception.people), or has located no scan\n";
    }
    return !a_.seconds || to_seconds(passed) < *a_.seconds;
  }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  const PeopleArguments& a_;
  Time start_;
  std::uint64_t messages_ = 0;
  bool complained_ = false;
};

int show_people(const PeopleArguments& a) {
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kPeople);
  if (a.team) wants.add(clients::Stream::kTeamPeople);
  PeoplePrinter printer(a);
  const auto read = read_core(
      a.socket, wants, [&](client::StreamMessage& message) { return printer.take(message); },
      [&] { return printer.idle(); });
  if (!read) return app::fail(read.error());
  if (printer.messages() > 0 || !a.seconds) return app::kDone;
  return app::fail({Errc::kNotFound,
                    "nothing was said of people in time",
                    a.socket.string(),
                    {},
                    "perception.people of the profile says whether the core follows them"});
}

}  // namespace

void add_people_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("people", "prints where the people around a running robot are");
  auto a = std::make_shared<PeopleArguments>();
  sub->add_option("--socket", a->socket, "socket of the core: robot.sock in the folder of its --sockets")
      ->default_val(client::kRobotSocket);
  sub->add_flag("--team", a->team,
                "also those whom other robots of the team follow, where they are in this robot's odom");
  sub->add_flag("--json", a->json, "one JSON object a line");
  sub->add_option("--seconds", a->seconds, "end after so many seconds; without it: at Ctrl-C")->check(app::above_zero);
  sub->callback([&commands, a] { commands.job = [a] { return show_people(*a); }; });
}

}  // namespace cairn::cli
