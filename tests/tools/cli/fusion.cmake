# SPDX-License-Identifier: Apache-2.0
cairn_test(cli_fusion
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/match_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/merge_command_test.cpp
  LINK cairn_run_command cairn_cli_fusion cairn_matching cairn_report)
cairn_compile_alone(${CMAKE_CURRENT_LIST_DIR}/match_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/merge_command_test.cpp)
