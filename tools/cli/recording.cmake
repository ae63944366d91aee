# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_recording
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/import_command.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect_command.cpp
          ${CMAKE_CURRENT_LIST_DIR}/record_command.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/inspect.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/inspect_stream.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/packet_figures.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/scan_figures.cpp
  PUBLIC cairn_cli_command cairn_recording cairn_velodyne
  PRIVATE cairn_app cairn_report CLI11::CLI11 fmt::fmt)
