# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_simulate
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/simulate_command.cpp
  PUBLIC cairn_hal CLI11::CLI11 nlohmann_json::nlohmann_json
  PRIVATE cairn_simulator)
