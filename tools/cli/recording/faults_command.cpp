// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/faults_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drivers/recording/faulty_source.hpp"
#include "drivers/recording/new_recording.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/safety/fault.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using recording::FaultySource;
using recording::Recording;

constexpr const char* kGroundTruth = "ground_truth.tum";
// In the order of recording::Spell.
const std::vector<std::string> kSpells{"silence", "disconnect", "stuck", "burst"};

// The options that each bring a fault.
constexpr std::array kFaults{"--drop",   "--repeat", "--swap",  "--cut",   "--flip",
                             "--extend", "--delay",  "--shift", "--freeze"};

struct FaultArguments {
  fs::path recording, out;
  std::string source, spell = "silence";
  recording::Faults faults;
  double freeze_s = 0, period_s = 10, delay_s = 0.05, shift_s = 0, shift_after_s = 0;
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
  faults.spell =
      static_cast<recording::Spell>(std::find(kSpells.begin(), kSpells.end(), options.spell) - kSpells.begin());
  faults.delay_by = from_seconds(options.delay_s);
  faults.shift = from_seconds(options.shift_s);
  faults.shift_after = from_seconds(options.shift_after_s);
  if (options.source.empty()) return faults;
  std::string known;
  for (std::size_t i = 0; i < recording.sources.size(); ++i) {
    if (recording.sources[i].id == options.source) faults.only = static_cast<SourceId>(i);
    known += (known.empty() ? "" : ", ") + recording.sources[i].id;
  }
  if (faults.only) return faults;
  return Error{Errc::kInvalidConfig, "the recording has no such source", options.source, {}, "it has " + known};
}

Result<Copied> copy(Source& source, recording::RecordingWriter& writer, const fs::path& of) {
  Copied copied;
  Packet packet;
  for (auto poll = source.next(packet, {}); !poll || *poll != Poll::kEnd; poll = source.next(packet, {})) {
    if (!poll || *poll != Poll::kPacket) continue;
    const bool written = writer.write(packet).has_value();
    copied.written += written ? 1 : 0;
    copied.refused += written ? 0 : 1;
    if (app::stop_requested()) return app::interrupted(of.string(), "nothing was written");
  }
  return copied;
}

report::Json to_json(const FaultArguments& options, const Copied& c) {
  return {{"out", options.out.string()},   {"packets", c.faults.packets},      {"written", c.written},
          {"dropped", c.faults.dropped},   {"repeated", c.faults.repeated},    {"swapped", c.faults.swapped},
          {"cut_short", c.faults.cut},     {"bits_flipped", c.faults.flipped}, {"frozen", c.faults.frozen},
          {"extended", c.faults.extended}, {"delayed", c.faults.delayed},      {"stuck", c.faults.stuck},
          {"in_bursts", c.faults.burst},   {"shifted", c.faults.shifted},      {"disconnects", c.faults.disconnects},
          {"not_recordable", c.refused}};
}

void print_table(const report::Json& json) {
  for (const auto& [key, value] : json.items())
    if (value != 0)
      std::cout << fmt::format("{:<15} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
}

/// The faulty recording, whole, in `folder`.
Result<Copied> write_faulty(Source& from, const FaultArguments& options, const recording::Faults& faults,
                            const Recording& recording, const fs::path& folder) {
  auto writer = recording::RecordingWriter::create(folder, recording);
  if (!writer) return writer.error();
  FaultySource source(from, faults);
  auto copied = copy(source, *writer, options.recording);
  if (!copied) return copied;
  if (const auto closed = writer->close(); !closed) return closed.error();
  copied->faults = source.counters();
  for (const char* name : {kGroundTruth, recording::kProfileFile}) {
    std::error_code error;
    const fs::path file = options.recording / name;
    if (fs::exists(file, error)) fs::copy_file(file, folder / name, error);
    if (error) return Error{Errc::kIo, "cannot copy the file", file.string(), {}, error.message()};
  }
  return copied;
}

int inject(const FaultArguments& options) {
  if (options.out.empty()) return app::fail({Errc::kInvalidConfig, "--out is missing: where the new recording goes"});
  if (const auto kept = keep_input(options.recording, options.out); !kept) return app::fail(kept.error());
  auto reader = recording::RecordingReader::open(options.recording);
  if (!reader) return app::fail(reader.error());
  Recording recording = (*reader)->recording();
  const auto faults = faults_of(options, recording);
  if (!faults) return app::fail(faults.error());
  recording.notes +=
      (recording.notes.empty() ? "" : "\n") + std::string("with injected faults, seed ") + std::to_string(faults->seed);
  const auto overwrite = options.overwrite ? recording::Overwrite::kYes : recording::Overwrite::kNo;
  auto place = recording::NewRecording::begin(options.out, overwrite);
  if (!place) return app::fail(place.error());
  app::catch_stop_signals();
  const auto copied = write_faulty(**reader, options, *faults, recording, place->folder());
  if (!copied) return app::fail(place->nothing_kept(copied.error()));
  if (const auto finished = place->finish(); !finished) return app::fail(finished.error());
  if (options.json) return app::print(to_json(options, *copied));
  print_table(to_json(options, *copied));
  return app::kDone;
}

/// Options that were given and would change nothing. CLI11 looks after those that need one other option.
Result<void> check_fault_options(const CLI::App& sub, bool list) {
  const auto unused = [](const std::string& option, const char* remedy) {
    return Error{Errc::kInvalidConfig, "would change nothing", option, {}, remedy};
  };
  if (list) {
    for (const CLI::Option* option : sub.get_options())
      if (const std::string name = option->get_name(); option->count() > 0 && name != "recording" && name != "--json")
        return unused(name, "`cairn faults list` prints the robot's faults; name a recording instead of list");
    return {};
  }
  const auto given = [&sub](const char* option) { return sub.count(option) > 0; };
  if (std::ranges::any_of(kFaults, given)) return {};
  for (const char* option : {"--source", "--seed"})
    if (given(option)) return unused(option, "no packet gets a fault; add one, such as --drop 0.01");
  return {};
}

/// What the core knows as faults, and what each leads to.
int list_faults(bool json) {
  report::Json rows = report::Json::array();
  for (const safety::FaultRow& row : safety::fault_table()) {
    if (!json)
      std::cout << fmt::format("{:2}  {:<16} {:<9} at least {:<9} {}\n", static_cast<int>(row.fault), row.code,
                               to_string(row.usual), to_string(row.least), row.doc);
    rows.push_back({{"number", static_cast<int>(row.fault)},
                    {"code", row.code},
                    {"usual", to_string(row.usual)},
                    {"least", to_string(row.least)},
                    {"doc", row.doc}});
  }
  return json ? app::print({{"faults", rows}}) : app::kDone;
}

/// Faults that one packet has or has not.
void add_shares(CLI::App& sub, FaultArguments& o) {
  const CLI::Range share(0.0, 1.0);
  sub.add_option("--drop", o.faults.drop, "share of packets that are lost")->check(share);
  sub.add_option("--repeat", o.faults.repeat, "share that arrives twice")->check(share);
  sub.add_option("--swap", o.faults.swap, "share that arrives after the next packet")->check(share);
  sub.add_option("--cut", o.faults.cut, "share that arrives without its end")->check(share);
  sub.add_option("--flip", o.faults.flip, "share that arrives with one bit turned")->check(share);
  sub.add_option("--extend", o.faults.extend, "share that arrives with bytes added")->check(share);
  auto* delay = sub.add_option("--delay", o.faults.delay, "share that arrives later, by --delay-by")->check(share);
  sub.add_option("--delay-by", o.delay_s, "delay of --delay, s")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->needs(delay);
}

/// Faults of all packets from some time on, or for some time.
void add_times(CLI::App& sub, FaultArguments& o) {
  auto* shift = sub.add_option("--shift", o.shift_s, "seconds added to all arrivals from --shift-after on")
                    ->check(CLI::Range(-1e6, 1e6));
  sub.add_option("--shift-after", o.shift_after_s, "seconds after which --shift begins")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(shift);
  auto* freeze = sub.add_option("--freeze", o.freeze_s,
                                "length of the spell at the end of each --period, s; without --spell the source is "
                                "silent")
                     ->check(CLI::Range(0.0, 1e6));
  sub.add_option("--spell", o.spell, "what happens to the source during --freeze")
      ->check(CLI::IsMember(kSpells))
      ->needs(freeze);
  sub.add_option("--period", o.period_s, "repeat the spell every so many seconds")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str()
      ->needs(freeze);
}

}  // namespace

void add_faults_command(app::Commands& commands) {
  auto* sub =
      commands.app.add_subcommand("faults", "copies a recording with faults: lost, late, repeated or damaged packets");
  auto o = std::make_shared<FaultArguments>();
  sub->add_option("recording", o->recording,
                  "folder of the recording; or `list`, which prints the robot's faults and their modes")
      ->required();
  sub->add_option("--out", o->out, "folder of the new recording");
  sub->add_option("--source", o->source, "source to damage, such as lidar; default: all");
  add_shares(*sub, *o);
  add_times(*sub, *o);
  sub->add_option("--seed", o->faults.seed, "seed of the faults; the same seed gives the same faults");
  sub->add_flag("--overwrite", o->overwrite, "replace the recording in --out");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o, sub] {
    commands.job = [o, sub] {
      const bool list = o->recording == "list";
      if (const auto fit = check_fault_options(*sub, list); !fit) return app::fail(fit.error());
      return list ? list_faults(o->json) : inject(*o);
    };
  });
}

}  // namespace cairn::cli
