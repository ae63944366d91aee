# SPDX-License-Identifier: Apache-2.0
cairn_test(failsafe
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/failsafe_test.cpp ${CMAKE_CURRENT_LIST_DIR}/failsafe_config_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/failsafe_state_test.cpp ${CMAKE_CURRENT_LIST_DIR}/overload_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/stuck_test.cpp
          ${PROJECT_SOURCE_DIR}/tests/support/allocation_count.cpp
  LINK cairn_failsafe)
