# SPDX-License-Identifier: Apache-2.0
cairn_library(generations
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/generations.cpp ${CMAKE_CURRENT_LIST_DIR}/saved_scans.cpp ${CMAKE_CURRENT_LIST_DIR}/saved_state.cpp ${CMAKE_CURRENT_LIST_DIR}/start_log.cpp
  PUBLIC cairn_hal cairn_mapping cairn_odometry
  PRIVATE PkgConfig::XXHASH)
