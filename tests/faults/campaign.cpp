// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/campaign.hpp"

namespace cairn::faults {
namespace {

std::string ms(const std::optional<Duration>& d) {
  return d ? std::to_string(*d / std::chrono::milliseconds(1)) + " ms" : "–";
}
std::string bound(Duration d) { return d > Duration{} ? " (≤ " + ms(d) + ")" : ""; }

void append_row(std::string& out, const Row& row) {
  out += "| " + row.id + " | " + row.fault + " | " + row.requirement + " | ";
  if (row.measure) {
    const Measured m = row.measure();
    out += std::string(to_string(m.worst)) + " | " + ms(m.detect) + bound(row.detect_within) + " | " + ms(m.recover) +
           bound(row.recover_within) + " | faults/Campaign.EveryRowHolds/" + row.id + " |\n";
  } else {
    out += std::string(to_string(row.worst)) + " | | | " + row.test + " |\n";
  }
}

}  // namespace

std::string to_markdown() {
  std::string out =
      "<!-- SPDX-License-Identifier: Apache-2.0 -->\n# What the robot survives\n\n"
      "Written by `tools/ci/fault_table.sh`; `test_faults` fails when it is out of date. Times are of virtual time: "
      "from the\n"
      "fault's beginning until the core acts on it, and from its end until all is normal again, with the required "
      "bound;\n"
      "for a stop (E…) until the frame that disables the motors is on the bus. A stop is latched: it ends by a "
      "request, so\n"
      "that no time of recovery is given. Rows without times are shown by the test that is named.\n\n"
      "| id | fault | what must hold | mode | detected | recovered | test |\n|---|---|---|---|---|---|---|\n";
  for (const auto& rows : {sensor_rows(), odometry_rows(), drive_rows(), computer_rows(), peer_rows()})
    for (const Row& row : rows) append_row(out, row);
  out += "\n## Left out\n\n| id | fault | why |\n|---|---|---|\n";
  for (const Row& row : rows_left_out()) out += "| " + row.id + " | " + row.fault + " | " + row.test + " |\n";
  return out;
}

}  // namespace cairn::faults
