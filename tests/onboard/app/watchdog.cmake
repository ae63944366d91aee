# SPDX-License-Identifier: Apache-2.0
cairn_test(watchdog
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/sd_notify_test.cpp ${CMAKE_CURRENT_LIST_DIR}/watchdog_test.cpp
          ${PROJECT_SOURCE_DIR}/tests/onboard/scheduler/health_test.cpp
  LINK cairn_watchdog)
