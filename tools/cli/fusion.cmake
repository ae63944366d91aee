# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_fusion
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/match_command.cpp ${CMAKE_CURRENT_LIST_DIR}/merge_command.cpp
  PUBLIC cairn_cli_command
  PRIVATE cairn_cli_save_map cairn_matching cairn_merging cairn_report CLI11::CLI11 fmt::fmt)
cairn_compile_alone(${CMAKE_CURRENT_LIST_DIR}/match_command.cpp ${CMAKE_CURRENT_LIST_DIR}/merge_command.cpp)
