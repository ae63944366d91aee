// SPDX-License-Identifier: Apache-2.0
#include "tools/team/team_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cairn::team_run {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json or_nulls(const std::vector<std::optional<double>>& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(or_null(value));
  return list;
}

Json robot_json(const TeamReport& report, Index i) {
  const RobotFigures& figures = report.figures.robots[i];
  const Radio::Counters& radio = report.network.radio().counters(i);
  const RobotEnd& end = report.end.robots[i];
  return {{"name", figures.name},
          {"team_sha256", figures.team_sha256},
          {"tx_bytes", radio.tx_bytes},
          {"rx_bytes", radio.rx_bytes},
          {"raw_bytes", report.recordings[i].raw_bytes},
          {"pose_error_m", or_nulls(figures.pose_error_m)},
          {"pose_error_deg", or_nulls(figures.pose_error_deg)},
          {"merged_with", figures.merged_with},
          {"not_merged", figures.not_merged},
          {"iou_world", or_null(figures.iou_world)},
          {"ticks", figures.ticks},
          {"missed_ticks", figures.missed_ticks},
          {"peer_kills", end.kills},
          {"peer_restarts", end.restarts},
          {"radio",
           {{"tx_packets", radio.tx_packets},
            {"queue_full", radio.queue_full},
            {"lost", radio.lost},
            {"doubled", radio.doubled},
            {"rx_packets", radio.rx_packets}}}};
}

Json link_json(const Radio& radio) {
  const LinkConfig& link = radio.link();
  return {{"rate_bit_s", link.rate_bit_s},
          {"queue_ms", link.queue_ms},
          {"loss", link.loss},
          {"delay_ms", link.delay_ms},
          {"jitter_ms", link.jitter_ms},
          {"reorder", link.reorder},
          {"duplicate", link.duplicate},
          {"seed", link.seed},
          {"max_late_ms", to_milliseconds(radio.most_late())}};
}

std::string number_or_dash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string merged_text(const RobotFigures& figures) {
  std::string text;
  for (std::size_t i = 0; i < figures.merged_with.size(); ++i)
    text += fmt::format("{}{} ({} m, {} deg)", i == 0 ? "" : ", ", figures.merged_with[i],
                        number_or_dash(figures.pose_error_m[i], 3), number_or_dash(figures.pose_error_deg[i], 2));
  return text.empty() ? "nobody" : text;
}

/// Pairs that are not merged, and what each of the two says of it.
std::string not_merged_text(const TeamReport& report) {
  std::string text;
  for (const RobotFigures& robot : report.figures.robots)
    for (const auto& [peer, reason] : robot.not_merged)
      text += fmt::format("{} is not merged with {}: {}\n", robot.name, peer, reason.empty() ? "no reason" : reason);
  return text;
}

/// Robots that were not run in real time show what this machine is worth, not what they are.
std::string warnings(const TeamReport& report) {
  constexpr double kMostMissed = 0.01;
  std::string text;
  for (const RobotFigures& robot : report.figures.robots)
    if (static_cast<double>(robot.missed_ticks) > kMostMissed * static_cast<double>(robot.ticks + robot.missed_ticks))
      text += fmt::format("{} missed {} of {} ticks: this machine is too slow or too busy for these robots\n",
                          robot.name, robot.missed_ticks, robot.ticks + robot.missed_ticks);
  return text;
}

}  // namespace

Json to_json(const TeamReport& report) {
  Json robots = Json::array();
  for (Index i = 0; i < report.figures.robots.size(); ++i) robots.push_back(robot_json(report, i));
  return {{"robots", std::move(robots)},
          {"wrong_merges", or_null(report.figures.wrong_merges)},
          {"iou_world", or_null(report.figures.iou_world)},
          {"seconds", to_seconds(report.end.took)},
          {"disagreements", report.figures.disagreements},
          {"disagreement_hints", report.figures.disagreement_hints},
          {"network", report.network.kind()},
          {"link", link_json(report.network.radio())}};
}

std::string to_table(const TeamReport& report) {
  std::string text = fmt::format("{:12} {:>9} {:>9} {:>9} {:>7}  {:10} {}\n", "robot", "sent kB", "heard kB", "raw MB",
                                 "IoU", "team map", "merged with (error of where it is seen)");
  for (Index i = 0; i < report.figures.robots.size(); ++i) {
    const RobotFigures& figures = report.figures.robots[i];
    const Radio::Counters& radio = report.network.radio().counters(i);
    text += fmt::format("{:12} {:9.0f} {:9.0f} {:9.1f} {:>7}  {:10} {}\n", figures.name,
                        1e-3 * static_cast<double>(radio.tx_bytes), 1e-3 * static_cast<double>(radio.rx_bytes),
                        1e-6 * static_cast<double>(report.recordings[i].raw_bytes),
                        number_or_dash(figures.iou_world, 3), figures.team_sha256.substr(0, 8), merged_text(figures));
  }
  text += not_merged_text(report);
  text += warnings(report);
  for (Index i = 0; i < report.figures.disagreements.size(); ++i)
    text += fmt::format("DIFFERENT team maps: {}\n  {}\n", report.figures.disagreements[i],
                        report.figures.disagreement_hints[i]);
  text += report.figures.wrong_merges ? fmt::format("{} wrong merges\n", *report.figures.wrong_merges)
                                      : "no truth in the recordings: errors, IoU and wrong merges are not known\n";
  return text;
}

}  // namespace cairn::team_run
