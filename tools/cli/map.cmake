# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_map
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/map_command.cpp
  PUBLIC cairn_hal CLI11::CLI11 nlohmann_json::nlohmann_json
  PRIVATE cairn_report fmt::fmt)
