# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_top
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/top_command.cpp ${CMAKE_CURRENT_LIST_DIR}/top/live_client.cpp
          ${CMAKE_CURRENT_LIST_DIR}/top/render.cpp
  PUBLIC cairn_cli_command cairn_live
  PRIVATE CLI11::CLI11 fmt::fmt)
