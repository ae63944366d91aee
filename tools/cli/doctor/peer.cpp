// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/peer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "hal/files/file.hpp"
#include "onboard/app/run.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/top/live_client.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using Peers = std::vector<LiveView::Peer>;
using Level = Finding::Level;

constexpr double kClockNoteS = 1;
constexpr const char* kContradicted = "deployments";

/// What to do about a reason, by what it has in it.
std::string remedy_for(const std::string& reason) {
  constexpr std::array<std::pair<const char*, const char*>, 15> kRemedies{{
      {kContradicted, "correct team.deployment in the profile that is wrong, or leave it out"},
      {"never heard",
       "start cairn-peers on both robots; its --peer addresses and --domain must fit, its --socket be the "
       "profile's team.socket"},
      {"no link", "look at the radio, and whether the peer's cairn-peers still runs"},
      {"another version", "bring both robots to one version of Cairn"},
      {"could be read", "bring both robots to one version of Cairn"},
      {"has voxels", "give both profiles the same mapping.resolution_m"},
      {"banned", "it is listened to again after a while; if that goes on, update or stop it"},
      {"said nothing", "it has not mapped anything yet, or the link carries hellos only"},
      {"too little mapped", "drive on"},
      {"being compared", "wait"},
      {"compares the two", "ask it: cairn doctor --peer there"},
      {"no place found", "drive where the other has been"},
      {"another pose", "ambiguous: drive on, to something that exists only once"},
      {"agreed on new ground", "nearly there: drive on where both have been"},
      {"at odds", "one of the robots' findings is wrong; they sort it out as their maps grow"},
  }};
  for (const auto& [part, remedy] : kRemedies)
    if (reason.find(part) != std::string::npos) return remedy;
  return "drive on: more of both maps decides it";
}

Finding judge(const LiveView::Peer& peer) {
  const std::string heard = peer.heard_s_ago >= 0 ? fmt::format(", heard {:.1f} s ago", peer.heard_s_ago) : "";
  const std::string figures = fmt::format(" ({} tiles{})", peer.tiles, heard);
  if (peer.merged && peer.reason.find(kContradicted) != std::string::npos)
    return {Level::kNote, peer.name + ": " + peer.reason + figures,
            "measure again where both were put down, and correct team.deployment in the profile that is wrong"};
  if (peer.merged) return {Level::kOk, peer.name + ": merged" + figures, {}};
  return {Level::kProblem, peer.name + " is not merged: " + peer.reason + figures, remedy_for(peer.reason)};
}

Findings problem(const Error& error) { return {{Level::kProblem, to_string(error), {}}}; }

Result<Peers> peers_of_report(const fs::path& run) {
  const auto bytes = read_file(run / "report.json", std::uint64_t{64} << 20U);
  if (!bytes) return bytes.error();
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  const Json json = Json::parse(text, text + bytes->size(), nullptr, false);
  if (!json.is_object() || !json.contains("peers") || !json["peers"].is_object())
    return Error{Errc::kMalformed, "not the report of a run", (run / "report.json").string(), {}, {}};
  Peers peers;
  for (const auto& [name, p] : json["peers"].items())
    if (p.is_object())
      peers.push_back({name, p.value("accepted", false), p.value("reason", ""), -1, p.value("tiles", std::uint64_t{0}),
                       p.value("tx_bytes", std::uint64_t{0}), p.value("rx_bytes", std::uint64_t{0}), 0});
  return peers;
}

Result<Peers> peers_of_core(const fs::path& socket) {
  auto client = LiveClient::connect(socket);
  if (!client) return client.error();
  const auto line = client->next(std::chrono::seconds(5));
  if (!line) return line.error();
  if (!*line) return Error{Errc::kLinkDown, "the core says nothing", socket.string(), {}, "its watch task hangs"};
  auto view = parse_line(**line);
  if (!view) return view.error();
  return std::move(view->peers);
}

Result<Peers> peers_of_recording(const fs::path& recording) {
  const fs::path out = fs::temp_directory_path() / ("cairn-doctor-" + std::to_string(::getpid()));
  RunOptions options;
  options.recording = recording;
  options.out = out;
  options.pace = Pace::kMaximum;
  if (const fs::path profile = recording / "config.yaml"; fs::exists(profile)) options.config = profile;
  const auto ran = run(options);
  auto peers = ran ? peers_of_report(out) : Result<Peers>(ran.error());
  std::error_code ignored;
  fs::remove_all(out, ignored);
  return peers;
}

}  // namespace

Findings judge_peers(const Peers& peers, const std::string& name) {
  Findings findings;
  for (const LiveView::Peer& peer : peers) {
    if (name != "all" && peer.name != name) continue;
    findings.push_back(judge(peer));
    if (std::abs(peer.clock_offset_s) > kClockNoteS)
      findings.push_back({Level::kNote,
                          fmt::format("{}: its clock differs by {:.1f} s", peer.name, peer.clock_offset_s),
                          "does no harm to the map; set the clocks (chrony) so that logs can be compared"});
  }
  if (!findings.empty()) return findings;
  const std::string who = name == "all" ? "any peer" : name;
  return {{Level::kProblem, who + ": never heard of", remedy_for("never heard")}};
}

Findings examine_peer(const PeerQuestion& question) {
  const auto peers = !question.recording.empty() ? peers_of_recording(question.recording)
                     : !question.run.empty()     ? peers_of_report(question.run)
                                                 : peers_of_core(question.live_view);
  return peers ? judge_peers(*peers, question.name) : problem(peers.error());
}

}  // namespace cairn::cli
