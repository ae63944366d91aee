// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/label_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "tools/cli/label/label_recording.hpp"

namespace cairn::cli {
namespace {

struct LabelArguments {
  LabelOptions label;
  bool json = false;
};

using NamedFigures = std::pair<const char*, const std::optional<NetworkFigures>*>;

std::array<NamedFigures, 3> figures_of(const LabelReport& r) {
  return {
      {{"segmentation", &r.segmentation}, {"detection", &r.detection}, {"thermal_detection", &r.thermal_detection}}};
}

report::Json to_json(const LabelOptions& options, const LabelReport& r) {
  report::Json json{{"recording", options.recording.string()},
                    {"out", options.out.empty() ? report::Json(nullptr) : report::Json(options.out.string())},
                    {"pictures", r.pictures},
                    {"correcting", r.correcting},
                    {"damaged", r.damaged},
                    {"damage", r.damage},
                    {"notes", r.notes},
                    {"interrupted", r.interrupted}};
  for (const auto& [name, figures] : figures_of(r))
    json[name] = *figures ? (*figures)->to_json() : report::Json(nullptr);
  return json;
}

void print_text(const LabelOptions& options, const LabelReport& r) {
  for (const auto& [name, figures] : figures_of(r))
    if (*figures) std::cout << (*figures)->to_text(name);
  if (r.correcting > 0)
    std::cout << r.correcting << " thermal pictures left out: taken during a flat-field correction\n";
  if (!options.out.empty()) std::cout << "written to " << options.out.string() << '\n';
  for (const std::string& note : r.notes) std::cerr << "cairn: note: " << note << '\n';
  for (const std::string& damage : r.damage) std::cerr << "cairn: left out: " << damage << '\n';
  if (r.damaged > r.damage.size()) std::cerr << "cairn: left out: " << r.damaged - r.damage.size() << " more\n";
  if (r.interrupted) std::cerr << "cairn: interrupted: the pictures so far are labelled\n";
}

int label(const LabelArguments& a) {
  if (a.label.overlay && a.label.out.empty()) {
    std::fputs("cairn: --overlay writes pictures: name a folder for them with --out\n", stderr);
    return app::kWrongArguments;
  }
  app::catch_stop_signals();
  LabelOptions options = a.label;
  options.stop = app::stop_requested;
  const auto done = app::while_working("labelling", [&] { return label_recording(options); });
  if (!done) return app::fail(done.error());
  if (a.json)
    app::print(to_json(options, *done));
  else
    print_text(options, *done);
  return done->interrupted ? app::kFailed : app::kDone;
}

}  // namespace

void add_label_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("label", "runs the profile's networks over the pictures of a recording");
  auto a = std::make_shared<LabelArguments>();
  sub->add_option("recording,--recording", a->label.recording, "folder of a recording: once, with or without the name")
      ->option_text("FOLDER")  // not REQUIRED twice: either one is enough
      ->required();
  sub->add_option("--config", a->label.config, "robot profile with a section perception; default: the recording's own");
  sub->add_option("--out", a->label.out,
                  "folder for labels/ and boxes.csv; the recording itself, if runs are to use them");
  sub->add_flag("--overlay", a->label.overlay, "pictures with coloured classes and boxes, too: OUT/overlay/CAMERA");
  sub->add_flag("--overwrite", a->label.overwrite, "replace labels/, boxes.csv and overlay/ in --out");
  sub->add_flag("--json", a->json, "one JSON object on stdout");
  sub->callback([&commands, a] { commands.job = [a] { return label(*a); }; });
}

}  // namespace cairn::cli
