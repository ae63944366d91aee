// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/campaign.hpp"

namespace cairn::faults {

using namespace std::chrono_literals;

std::vector<Row> output_rows() {
  const auto row = [](const char* id, const char* fault, const char* requirement, const char* test) {
    return Row{id, fault, requirement, 0ms, 0ms, safety::Mode::kNormal, test};
  };
  return {
      row("C24", "SIGINT or SIGTERM at random instants of a replay, and a second one",
          "The run stops at the next tick. All its files are there, readable, and say that it was interrupted.",
          "output_campaign/OutputCampaign.AnInterruptedReplayLeavesAllItsFilesMarked"),
      row("C25", "kill -9 at random instants of a replay",
          "The earlier results in its output folder stay readable. The next run removes what was left.",
          "output_campaign/OutputCampaign.AKilledReplayLeavesTheEarlierResults"),
      row("C26", "kill -9 while a recording is written",
          "All that was flushed can be read. The recording says that it is unfinished.",
          "recording/RecordingFolder.WhatWasFlushedCanBeReadAfterAKill"),
      row("C27", "a command whose output is its own input, or lies in it", "It is refused. The input stays as it is.",
          "cli_recording/FaultsCommand.AnOutputThatWouldReplaceItsInputIsRefused"),
      row("C28", "a run without a scan into the folder of an earlier run",
          "The earlier map stays. The new report goes into a folder of its own.",
          "app/RunOutputTest.ARunWithoutAScanKeepsTheEarlierResults"),
  };
}

}  // namespace cairn::faults
