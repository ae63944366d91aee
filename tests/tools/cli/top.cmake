# SPDX-License-Identifier: Apache-2.0
cairn_test(cli_top
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/top_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/top/render_test.cpp
  LINK cairn_cli_top cairn_run_command)
