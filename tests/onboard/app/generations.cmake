# SPDX-License-Identifier: Apache-2.0
cairn_test(generations
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/generations_test.cpp ${CMAKE_CURRENT_LIST_DIR}/saved_scans_test.cpp ${CMAKE_CURRENT_LIST_DIR}/saved_state_test.cpp ${CMAKE_CURRENT_LIST_DIR}/start_log_test.cpp
  LINK cairn_generations)
