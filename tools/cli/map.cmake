# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_save_map
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/save_map.cpp
  PUBLIC cairn_mapping)
cairn_library(cli_map
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/map_check_command.cpp ${CMAKE_CURRENT_LIST_DIR}/map_command.cpp
  PUBLIC cairn_cli_command
  PRIVATE cairn_cli_save_map cairn_matching cairn_report CLI11::CLI11 fmt::fmt)
cairn_compile_alone(${CMAKE_CURRENT_LIST_DIR}/map_check_command.cpp ${CMAKE_CURRENT_LIST_DIR}/map_command.cpp)
