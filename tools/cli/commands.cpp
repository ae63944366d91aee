// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands.hpp"

#include "tools/cli/calibrate/calibrate_command.hpp"
#include "tools/cli/doctor/doctor_command.hpp"
#include "tools/cli/drive/drive_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"
#include "tools/cli/label/label_command.hpp"
#include "tools/cli/map/evaluate_command.hpp"
#include "tools/cli/map/map_command.hpp"
#include "tools/cli/map/match_command.hpp"
#include "tools/cli/map/merge_command.hpp"
#include "tools/cli/recording/faults_command.hpp"
#include "tools/cli/recording/import_command.hpp"
#include "tools/cli/recording/record_command.hpp"
#include "tools/cli/recording/send_command.hpp"
#include "tools/cli/stream/people_command.hpp"
#include "tools/cli/stream/pose_command.hpp"
#include "tools/cli/team/team_command.hpp"
#include "tools/cli/thermal/thermal_command.hpp"
#include "tools/cli/top/top_command.hpp"
#ifdef CAIRN_HAS_SIMULATOR
#include "tools/cli/simulate/simulate_command.hpp"
#endif

namespace cairn::cli {

void add_tool_commands(app::Commands& commands) {
  add_record_command(commands);
  add_send_command(commands);
#ifdef CAIRN_HAS_SIMULATOR  // it needs Embree, which Debian has for x86-64 only
  add_simulate_command(commands);
#endif
  add_import_command(commands);
  add_inspect_command(commands);
  add_calibrate_command(commands);
  add_label_command(commands);
  add_map_command(commands);
  add_match_command(commands);
  add_merge_command(commands);
  add_evaluate_command(commands);
  add_doctor_command(commands);
  add_faults_command(commands);
  add_team_command(commands);
  add_top_command(commands);
  add_pose_command(commands);
  add_people_command(commands);
  add_thermal_command(commands);
  add_drive_commands(commands);
}

}  // namespace cairn::cli
