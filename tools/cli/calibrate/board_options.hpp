// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/cli/calibrate/board_search.hpp"

namespace CLI {
class App;
}

namespace cairn::cli {

/// What every `cairn calibrate …` is told.
struct BoardOptions {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path config, out;
  std::string board, format = "kalibr", model = "radtan";
  double square_m = 0;
  int every = 1;
  bool json = false, thermal = false, inverted = false;
};

/// Recordings, board, profile, output.
void add_board_options(CLI::App& command, BoardOptions& options);
/// --inverted, for pictures of a thermal camera.
void add_inverted_option(CLI::App& command, BoardOptions& options);
/// --format and --model, for what gives intrinsics.
void add_lens_options(CLI::App& command, BoardOptions& options);
/// Error: that of the board's size.
[[nodiscard]] Result<BoardSearch> search_of(const BoardOptions& options, BoardSearch::Eyes eyes);

}  // namespace cairn::cli
