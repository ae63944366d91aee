// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/peer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/app/run.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/top/live_client.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using Peers = std::vector<app::LiveView::Peer>;
using Level = Finding::Level;

constexpr double kClockNoteS = 1;
constexpr const char* kContradicted =
    "correct team.deployment or team.satellites in the profile that is wrong, or `cairn place` the robot";

Finding judge(const app::LiveView::Peer& peer) {
  const std::string heard = peer.heard_s_ago >= 0 ? fmt::format(", heard {:.1f} s ago", peer.heard_s_ago) : "";
  const std::string figures = fmt::format(" ({} tiles{})", peer.tiles, heard);
  if (peer.merged && peer.deployment_contradicted)
    return {Level::kNote, peer.name + ": " + peer.reason + figures,
            "measure again where both were put down, and correct team.deployment in the profile that is wrong"};
  if (peer.merged) return {Level::kOk, peer.name + ": merged" + figures, {}};
  const auto state = team::peer_state_from(peer.state).value_or(team::PeerState::kUndecided);
  return {Level::kProblem, peer.name + " is not merged: " + peer.reason + figures,
          peer.deployment_contradicted ? kContradicted : remedy_for(state, peer.name)};
}

Findings problem(const Error& error) { return {{Level::kProblem, to_string(error), {}}}; }

/// `folder` has no report.json: which of its folders have.
Error no_run(const fs::path& folder, const Error& missing) {
  std::vector<std::string> runs;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (fs::exists(entry.path() / "report.json", ignored)) runs.push_back(entry.path().filename().string());
  if (runs.empty()) return missing;
  std::ranges::sort(runs);
  std::string names;
  for (const std::string& run : runs) names += (names.empty() ? "" : ", ") + run;
  return {Errc::kNotFound, "this folder is no run", folder.string(), {}, "it holds " + names + ": name one of them"};
}

Result<Peers> peers_of_report(const fs::path& run) {
  const auto bytes = read_file(run / "report.json", std::uint64_t{64} << 20U);
  if (!bytes) return no_run(run, bytes.error());
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  const report::Json json = report::Json::parse(text, text + bytes->size(), nullptr, false);
  if (!json.is_object() || !json.contains("peers") || !json["peers"].is_object())
    return Error{Errc::kMalformed, "not the report of a run", (run / "report.json").string(), {}, {}};
  if (json.contains("team") && json["team"].is_null())
    return Error{Errc::kNotFound,
                 "this run took no part in a team",
                 run.string(),
                 {},
                 "start the core with --peers and give it team.id"};
  Peers peers;
  for (const auto& [name, p] : json["peers"].items())
    if (p.is_object())
      peers.push_back({.name = name,
                       .merged = p.value("accepted", false),
                       .state = p.value("state", ""),
                       .reason = p.value("reason", ""),
                       .tiles = p.value("tiles", std::uint64_t{0}),
                       .tx_bytes = p.value("tx_bytes", std::uint64_t{0}),
                       .rx_bytes = p.value("rx_bytes", std::uint64_t{0}),
                       .deployment_contradicted = p.value("deployment_contradicted", false)});
  return peers;
}

Result<Peers> peers_of_core(const fs::path& socket) {
  auto client = LiveClient::connect(socket);
  if (!client) return client.error();
  const auto line = client->next(std::chrono::seconds(5));
  if (!line) return line.error();
  if (!*line) return Error{Errc::kLinkDown, "the core says nothing", socket.string(), {}, "its watch task hangs"};
  auto view = app::parse_line(**line);
  if (!view) return view.error();
  return std::move(view->peers);
}

Result<Peers> peers_of_recording(const fs::path& recording) {
  const fs::path out = fs::temp_directory_path() / ("cairn-doctor-" + std::to_string(::getpid()));
  app::RunOptions options;
  options.recording = recording;
  options.out = out;
  options.pace = app::Pace::kMaximum;
  const auto ran = app::run(options);
  auto peers = ran ? peers_of_report(out) : Result<Peers>(ran.error());
  std::error_code ignored;
  fs::remove_all(out, ignored);
  if (!peers && peers.error().where == out.string()) peers.error().where = recording.string();
  return peers;
}

}  // namespace

std::string remedy_for(team::PeerState state, const std::string& peer) {
  switch (state) {
    case team::PeerState::kMerged:
      return "";
    case team::PeerState::kNeverHeard:
      return "start the cores with --peers, and cairn-peers on both robots; its --peer addresses and --domain must "
             "fit, its --socket be the "
             "profile's team.socket";
    case team::PeerState::kBanned:
      return "it is listened to again after a while; if that goes on, update or stop it";
    case team::PeerState::kOtherVersion:
    case team::PeerState::kUnreadable:
      return "bring both robots to one version of Cairn";
    case team::PeerState::kOtherResolution:
      return "give both profiles the same mapping.resolution_m";
    case team::PeerState::kNoLink:
      return "look at the radio, and whether the peer's cairn-peers still runs";
    case team::PeerState::kNoMap:
      return "wait until the peer has mapped; then check the link's rate and loss";
    case team::PeerState::kTooLittleMapped:
      return "drive on";
    case team::PeerState::kPeerCompares:
      return "run cairn doctor --peer all on " + peer;
    case team::PeerState::kBeingCompared:
      return "wait";
    case team::PeerState::kNoPlace:
      return "drive where the other has been";
    case team::PeerState::kAtOdds:
      return "one of the robots' findings is wrong; they sort it out as their maps grow";
    case team::PeerState::kAmbiguous:
      return "ambiguous: drive on, to something that exists only once";
    case team::PeerState::kAgreeing:
      return "nearly there: drive on where both have been";
    case team::PeerState::kContradicted:
      return "drive where the other has been: the maps contradict the place that was found";
    case team::PeerState::kUndecided:
      break;
  }
  return "drive on: more of both maps decides it";
}

Findings judge_peers(const Peers& peers, const std::string& name) {
  Findings findings;
  for (const app::LiveView::Peer& peer : peers) {
    if (name != "all" && peer.name != name) continue;
    findings.push_back(judge(peer));
    if (std::abs(peer.clock_offset_s) > kClockNoteS)
      findings.push_back({Level::kNote,
                          fmt::format("{}: its clock differs by {:.1f} s", peer.name, peer.clock_offset_s),
                          "does no harm to the map; set the clocks (chrony) so that logs can be compared"});
  }
  if (!findings.empty()) return findings;
  const std::string remedy = remedy_for(team::PeerState::kNeverHeard, name);
  if (peers.empty()) return {{Level::kProblem, "no robot of the team was heard", remedy}};
  std::string heard;
  for (const app::LiveView::Peer& peer : peers) heard += (heard.empty() ? "" : ", ") + peer.name;
  return {{Level::kProblem, name + ": no robot of this name was heard; heard: " + heard, remedy}};
}

Findings examine_peer(const PeerQuestion& question) {
  const auto peers = !question.recording.empty() ? peers_of_recording(question.recording)
                     : !question.run.empty()     ? peers_of_report(question.run)
                                                 : peers_of_core(question.live_view);
  return peers ? judge_peers(*peers, question.name) : problem(peers.error());
}

}  // namespace cairn::cli
