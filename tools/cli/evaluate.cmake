# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_evaluate
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/evaluate_command.cpp
  PUBLIC cairn_cli_command
  PRIVATE cairn_report CLI11::CLI11 fmt::fmt)
