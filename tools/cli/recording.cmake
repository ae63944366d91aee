# SPDX-License-Identifier: Apache-2.0
cairn_library(cli_recording
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/import_command.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect_command.cpp
          ${CMAKE_CURRENT_LIST_DIR}/record_command.cpp ${CMAKE_CURRENT_LIST_DIR}/replay_command.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/inspect.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/inspect_stream.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/packet_figures.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/scan_figures.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/sensor_figures.cpp
          ${CMAKE_CURRENT_LIST_DIR}/inspect/can_figures.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/peer_figures.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect/native_file.cpp ${CMAKE_CURRENT_LIST_DIR}/doctor_command.cpp ${CMAKE_CURRENT_LIST_DIR}/faults_command.cpp
          ${CMAKE_CURRENT_LIST_DIR}/doctor/machine.cpp ${CMAKE_CURRENT_LIST_DIR}/doctor/peer.cpp ${CMAKE_CURRENT_LIST_DIR}/doctor/robot.cpp
  PUBLIC cairn_cli_command cairn_recording cairn_velodyne
  PRIVATE cairn_camera cairn_depth cairn_drive cairn_gpio cairn_peers cairn_thermal cairn_app cairn_cli_top cairn_report CLI11::CLI11 fmt::fmt)
