// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/faults_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "drivers/recording/faulty_source.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/app/report/report_json.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using recording::FaultySource;
using recording::Recording;

struct FaultArguments {
  fs::path recording, out;
  std::string source;
  recording::Faults faults;
  double freeze_s = 0, period_s = 10;
  bool overwrite = false, json = false;
};

struct Copied {
  FaultySource::Counters faults;
  std::uint64_t written = 0;
  std::uint64_t refused = 0;  ///< what a native file cannot hold, such as half a picture
};

Result<recording::Faults> faults_of(const FaultArguments& options, const Recording& recording) {
  recording::Faults faults = options.faults;
  if (options.freeze_s > 0) {
    faults.freeze = from_seconds(options.freeze_s);
    faults.period = from_seconds(options.period_s);
  }
  if (options.source.empty()) return faults;
  std::string known;
  for (std::size_t i = 0; i < recording.sources.size(); ++i) {
    if (recording.sources[i].id == options.source) faults.only = static_cast<SourceId>(i);
    known += (known.empty() ? "" : ", ") + recording.sources[i].id;
  }
  if (faults.only) return faults;
  return Error{Errc::kInvalidConfig, "the recording has no such source", options.source, {}, "it has " + known};
}

Copied copy(Source& source, recording::RecordingWriter& writer) {
  Copied copied;
  Packet packet;
  for (auto poll = source.next(packet, {}); !poll || *poll != Poll::kEnd; poll = source.next(packet, {})) {
    if (!poll || *poll != Poll::kPacket) continue;
    const bool written = writer.write(packet).has_value();
    copied.written += written ? 1 : 0;
    copied.refused += written ? 0 : 1;
  }
  return copied;
}

Json to_json(const FaultArguments& options, const Copied& c) {
  return {{"out", options.out.string()}, {"packets", c.faults.packets},      {"written", c.written},
          {"dropped", c.faults.dropped}, {"repeated", c.faults.repeated},    {"swapped", c.faults.swapped},
          {"cut_short", c.faults.cut},   {"bits_flipped", c.faults.flipped}, {"frozen", c.faults.frozen},
          {"not_recordable", c.refused}};
}

void print_table(const Json& json) {
  for (const auto& [key, value] : json.items())
    if (value != 0)
      std::cout << fmt::format("{:<15} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
}

int inject(const FaultArguments& options) {
  auto reader = recording::RecordingReader::open(options.recording);
  if (!reader) return fail(reader.error());
  Recording recording = (*reader)->recording();
  const auto faults = faults_of(options, recording);
  if (!faults) return fail(faults.error());
  recording.notes +=
      (recording.notes.empty() ? "" : "\n") + std::string("with injected faults, seed ") + std::to_string(faults->seed);
  const auto overwrite = options.overwrite ? recording::Overwrite::kYes : recording::Overwrite::kNo;
  auto writer = recording::RecordingWriter::create(options.out, recording, overwrite);
  if (!writer) return fail(writer.error());
  FaultySource source(**reader, *faults);
  Copied copied = copy(source, *writer);
  if (const auto closed = writer->close(); !closed) return fail(closed.error());
  copied.faults = source.counters();
  std::error_code ignored;
  const fs::path truth = options.recording / "ground_truth.tum";
  if (fs::exists(truth, ignored))
    fs::copy_file(truth, options.out / "ground_truth.tum", fs::copy_options::overwrite_existing, ignored);
  if (options.json) return print(to_json(options, copied));
  print_table(to_json(options, copied));
  return kDone;
}

}  // namespace

void add_faults_command(Commands& commands) {
  auto* sub =
      commands.app.add_subcommand("faults", "a recording as bad cables, radios and computers would have made it");
  auto o = std::make_shared<FaultArguments>();
  const CLI::Range share(0.0, 1.0);
  sub->add_option("recording", o->recording, "folder of the recording")->required();
  sub->add_option("--out", o->out, "folder of the new recording")->required();
  sub->add_option("--source", o->source, "only this source, such as lidar; default: all");
  sub->add_option("--drop", o->faults.drop, "share of packets that are lost")->check(share);
  sub->add_option("--repeat", o->faults.repeat, "share that arrives twice")->check(share);
  sub->add_option("--swap", o->faults.swap, "share that arrives after the next packet")->check(share);
  sub->add_option("--cut", o->faults.cut, "share that arrives without its end")->check(share);
  sub->add_option("--flip", o->faults.flip, "share that arrives with one bit turned")->check(share);
  sub->add_option("--freeze", o->freeze_s, "silence of so many seconds at the end of every --period")
      ->check(CLI::Range(0.0, 1e6));
  sub->add_option("--period", o->period_s, "seconds")->check(CLI::Range(0.001, 1e6));
  sub->add_option("--seed", o->faults.seed, "other faults for another number");
  sub->add_flag("--overwrite", o->overwrite, "replace the recording in --out");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return inject(*o); }; });
}

}  // namespace cairn::cli
