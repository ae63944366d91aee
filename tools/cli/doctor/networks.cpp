// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/networks.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "hal/clock.hpp"
#include "onboard/perception/networks/open_networks.hpp"

namespace cairn::cli {
namespace {

using Level = Finding::Level;

Image black_picture() {
  Image picture;
  picture.resize(PixelFormat::kBgr8, 640, 360);
  return picture;
}

Finding refusal(const std::string& name, Error error) {
  const std::string remedy = std::exchange(error.detail, {});
  return {Level::kProblem, name + ": " + to_string(error), remedy};
}

Findings say(const std::string& name, const networks::NetworkFacts& facts, double rate_hz, Duration picture) {
  const std::string what = fmt::format("{}: {}, {}x{} in, {} out, {:.0f} ms a picture", name, facts.file.string(),
                                       facts.input_width, facts.input_height, facts.output, to_milliseconds(picture));
  Findings findings;
  if (to_seconds(picture) * rate_hz > 1)
    findings.push_back(
        {Level::kNote, what,
         fmt::format("rate_hz asks for {:.3g} pictures per second: lower it, or take a smaller input", rate_hz)});
  else
    findings.push_back({Level::kOk, what, {}});
  if (!facts.checked)
    findings.push_back({Level::kNote, name + ": the model is not checked",
                        "put sha256: " + facts.sha256 + " beside model in the profile"});
  return findings;
}

/// `open` gives a network and fills the facts; `ask` runs it once.
template <class Open, class Ask>
Findings examine(const networks::NetworkConfig& config, const std::string& name, const std::filesystem::path& profile,
                 Open open, Ask ask) {
  if (!config.exists()) return {};
  const auto folders = networks::model_folders(profile);
  networks::NetworkFacts facts;
  const auto network = open(config, folders, &facts);
  if (!network) return {refusal(name, network.error())};
  const Image picture = black_picture();
  const LiveClock clock;
  const Time start = clock.now();
  if (const auto answer = ask(**network, picture); !answer) return {refusal(name, answer.error())};
  return say(name, facts, config.rate_hz, clock.now() - start);
}

}  // namespace

Findings examine_networks(const networks::PerceptionConfig& config, const std::filesystem::path& profile) {
  const auto segment = [](Segmenter& s, const Image& picture) { return s.segment(picture); };
  const auto detect = [](Detector& d, const Image& picture) { return d.detect(picture); };
  Findings findings =
      examine(config.segmentation, "perception.segmentation", profile, networks::open_segmenter, segment);
  for (auto found :
       {examine(config.detection, "perception.detection", profile, networks::open_detector, detect),
        examine(config.thermal_detection, "perception.thermal_detection", profile, networks::open_detector, detect)})
    findings.insert(findings.end(), found.begin(), found.end());
  return findings;
}

}  // namespace cairn::cli
