// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/inspect_command.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "onboard/app/cli/working_line.hpp"
#include "tools/cli/inspect/inspect.hpp"
#include "tools/cli/inspect/plain_text.hpp"

namespace cairn::cli {
namespace {

struct InspectArguments {
  InspectOptions inspect;
  bool json = false;
};

int run(const InspectArguments& options) {
  const auto found = app::while_working("reading", [&] { return inspect(options.inspect); });
  if (!found) return app::fail(found.error());
  if (options.json) return app::print(*found);
  std::cout << to_plain_text(*found);
  return app::kDone;
}

}  // namespace

void add_inspect_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand(
      "inspect",
      "says what a recording, run, capture, map, trajectory, point cloud, picture, array or calibration holds");
  auto o = std::make_shared<InspectArguments>();
  sub->add_option("path", o->inspect.path, "file or folder")->required();
  sub->add_option("--model", o->inspect.model, "sensor model, instead of the one in the packets or the recording");
  auto* out = sub->add_option(
      "--out", o->inspect.out,
      "file for one scan as PCD: x y z intensity ring time return_type; or for a calibration, see --as");
  sub->add_option("--scan", o->inspect.scan, "number of the scan, from 0; default: the first complete one")->needs(out);
  sub->add_option("--as", o->inspect.as, "format of a calibration in --out")
      ->check(CLI::IsMember({"kalibr", "ros", "opencv"}))
      ->needs(out);
  sub->add_option("--camera", o->inspect.camera,
                  "number of the camera in --out, from 0, which is the default; kalibr: all of them")
      ->needs(out);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return run(*o); }; });
}

}  // namespace cairn::cli
