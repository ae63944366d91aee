// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/campaign.hpp"

namespace cairn::faults {
namespace {

std::string ms(const std::optional<Duration>& d) {
  return d ? std::to_string(*d / std::chrono::milliseconds(1)) + " ms" : "–";
}
std::string bound(Duration d) { return d > Duration{} ? " (≤ " + ms(d) + ")" : ""; }

}  // namespace

std::string to_line(const Row& row, const Measured& m) {
  return "| " + row.id + " | " + row.fault + " | " + row.requirement + " | " + std::string(to_string(m.worst)) + " | " +
         ms(m.detect) + bound(row.detect_within) + " | " + ms(m.recover) + bound(row.recover_within) +
         " | faults/Campaign.EveryRowHolds/" + row.id + " |\n";
}

std::vector<Row> rows_left_out() {
  const auto row = [](const char* id, const char* fault, const char* why) {
    return Row{id, fault, "", Duration{}, Duration{}, safety::Mode::kNormal, why};
  };
  return {
      row("X2", "the time of day jumps during a run", "only metadata reads it (tools/ci/check_layers.sh)"),
      row("X3", "a USB camera is unplugged and plugged in 1000 times",
          "needs a guest kernel with dummy_hcd; recovery has a test in virtual time (camera/Recovery)"),
      row("X4", "power cut at any write", "needs dm-log-writes in a guest; C7 tests every failing call"),
      row("X5", "hardware watchdog", "needs softdog in a guest"),
      row("X6", "cgroup memory limit, order of the OOM killer's victims",
          "needs cgroups; config/systemd sets the order"),
      row("X7", "CPU overload by stress-ng", "not deterministic; C1, C15 and C16 test the logic in virtual time"),
      row("X10", "unauthorised, expired or revoked certificate; strangers", "there are no certificates yet"),
      row("X8", "bad update, A/B slots", "there is no updater yet"),
  };
}

std::string to_markdown(const std::function<std::string(const Row&)>& measured_line) {
  std::string out =
      "<!-- SPDX-License-Identifier: Apache-2.0 -->\n# What the robot survives\n\n"
      "`tools/ci/fault_table.sh` writes this page from the rows in `tests/faults`. The test `test_faults`\n"
      "fails when the page is out of date. [Robot setup](robot-setup.md#faults-and-modes) explains the modes.\n\n"
      "- Rows are named by what fails. L: LiDAR and cameras. D: drive. E: e-stop. C: computer. P: peers.\n"
      "- Times are virtual, so they are the same on every machine. The required bound is in brackets.\n"
      "- *Detected* counts from the beginning of the fault until the core acts on it. In rows E it counts\n"
      "  until the frame that disables the motors is on the bus.\n"
      "- *Recovered* counts from the end of the fault until all is normal again.\n"
      "- A stop is latched. It ends only with a request, so these rows have no time of recovery.\n"
      "- Rows without times are shown by the test in the last column.\n\n"
      "| id | fault | what must hold | mode | detected | recovered | test |\n|---|---|---|---|---|---|---|\n";
  for (const auto& rows :
       {sensor_rows(), eye_rows(), odometry_rows(), garbage_rows(), drive_rows(), computer_rows(), peer_rows()})
    for (const Row& row : rows)
      out += row.measure ? measured_line(row)
                         : "| " + row.id + " | " + row.fault + " | " + row.requirement + " | " +
                               std::string(to_string(row.worst)) + " | | | " + row.test + " |\n";
  out += "\n## Left out\n\n| id | fault | why |\n|---|---|---|\n";
  for (const Row& row : rows_left_out()) out += "| " + row.id + " | " + row.fault + " | " + row.test + " |\n";
  return out;
}

}  // namespace cairn::faults
