// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "onboard/safety/fault.hpp"

namespace cairn::faults {

/// What a row's run in virtual time gave: the same on every machine.
struct Measured {
  std::optional<Duration> detect;  ///< from the fault's beginning to the first sign that the core knows
  std::optional<Duration>
      recover;  ///< from the fault's end to normal operation; none: it is latched, or nothing changed
  safety::Mode worst = safety::Mode::kNormal;
  bool held = true;  ///< everything else that the requirement says
};

/// A row of the fault matrix. Either measured here, or by the named test, or left out with the reason.
struct Row {
  std::string id;  ///< L…: LiDAR and cameras, D…: drive, E…: e-stop, C…: computer, P…: peers; never changes its meaning
  std::string fault;                           ///< as the matrix says
  std::string requirement;                     ///< what must hold
  Duration detect_within{}, recover_within{};  ///< zero: nothing is required
  safety::Mode worst = safety::Mode::kNormal;  ///< the mode it must lead to
  std::string test;                            ///< what shows it, or why it is left out
  std::function<Measured()> measure{};         ///< empty: `test` alone
};

[[nodiscard]] std::vector<Row> sensor_rows();
/// Of cameras that look for people.
[[nodiscard]] std::vector<Row> eye_rows();
[[nodiscard]] std::vector<Row> odometry_rows();
[[nodiscard]] std::vector<Row> garbage_rows();
[[nodiscard]] std::vector<Row> drive_rows();
[[nodiscard]] std::vector<Row> computer_rows();
/// Those of computer_rows() that are about a command's results.
[[nodiscard]] std::vector<Row> output_rows();
[[nodiscard]] std::vector<Row> peer_rows();
/// Of the matrix, but not automated here.
[[nodiscard]] std::vector<Row> rows_left_out();

/// A measured row of docs/faults.md, with its newline.
[[nodiscard]] std::string to_line(const Row& row, const Measured& measured);

/// All, as docs/faults.md has them. `measured_line` gives the lines of the rows that are measured.
[[nodiscard]] std::string to_markdown(const std::function<std::string(const Row&)>& measured_line);

}  // namespace cairn::faults
