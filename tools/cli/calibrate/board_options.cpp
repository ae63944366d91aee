// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/board_options.hpp"

#include <CLI/CLI.hpp>

namespace cairn::cli {

void add_board_options(CLI::App& command, BoardOptions& o) {
  command.add_option("recordings", o.recordings, "folders of recordings that show the board")
      ->required()
      ->check(CLI::ExistingDirectory);
  command.add_option("--board", o.board, "inner corners of a row and of a column, such as 9x6")->required();
  command.add_option("--square-m", o.square_m, "side of a square, metres")->required()->check(CLI::Range(0.001, 1.0));
  command.add_option("--config", o.config, "robot profile; default: the recording's own");
  command.add_option("--out", o.out, "file to write; it is left out if the calibration is refused")->required();
  command.add_option("--every", o.every, "look at every so many pictures only")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_flag("--json", o.json, "one JSON object on stdout");
}

void add_inverted_option(CLI::App& command, BoardOptions& o) {
  command.add_flag("--inverted", o.inverted, "squares that are dark on the board are bright in the thermal pictures");
}

void add_lens_options(CLI::App& command, BoardOptions& o) {
  command.add_option("--model", o.model, "lens: radtan (k1 k2 p1 p2), or equidistant (fisheye, k1 to k4)")
      ->check(CLI::IsMember({"radtan", "equidistant"}))
      ->capture_default_str();
  command.add_option("--format", o.format, "of the file: kalibr, ros or opencv")
      ->check(CLI::IsMember({"kalibr", "ros", "opencv"}))
      ->capture_default_str();
}

Result<BoardSearch> search_of(const BoardOptions& o, BoardSearch::Eyes eyes) {
  const auto board = calibration::parse_board(o.board, o.square_m);
  if (!board) return board.error();
  return BoardSearch{.recordings = o.recordings,
                     .config = o.config,
                     .board = *board,
                     .eyes = eyes,
                     .every = o.every,
                     .thermal = o.thermal,
                     .inverted = o.inverted};
}

}  // namespace cairn::cli
