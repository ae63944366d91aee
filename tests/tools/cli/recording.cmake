# SPDX-License-Identifier: Apache-2.0
cairn_test(cli_recording
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/import_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect_command_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/doctor_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/faults_command_test.cpp ${CMAKE_CURRENT_LIST_DIR}/inspect_sensors_test.cpp ${CMAKE_CURRENT_LIST_DIR}/record_command_test.cpp
  LINK cairn_camera cairn_run_command cairn_cli_recording cairn_app cairn_report)
