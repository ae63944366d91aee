# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_team
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/team_command.cpp
  PUBLIC cairn_cli_command
  PRIVATE cairn_team_tool cairn_app CLI11::CLI11 fmt::fmt)
