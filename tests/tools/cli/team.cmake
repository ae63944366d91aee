# SPDX-License-Identifier: Apache-2.0
cairn_test(cli_team
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/team_command_test.cpp
  LINK cairn_cli_team cairn_run_command cairn_app cairn_recording cairn_mapping fmt::fmt)
