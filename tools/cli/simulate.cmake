# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_simulate
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/simulate_command.cpp
  PUBLIC cairn_cli_command
  PRIVATE cairn_simulator CLI11::CLI11)
