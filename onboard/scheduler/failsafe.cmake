# SPDX-License-Identifier: Apache-2.0
# What the robot may do and what it leaves undone: pure state machines, apart from the executive that runs them.
cairn_library(failsafe
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/failsafe.cpp ${CMAKE_CURRENT_LIST_DIR}/failsafe_config.cpp
          ${CMAKE_CURRENT_LIST_DIR}/fault.cpp ${CMAKE_CURRENT_LIST_DIR}/health.cpp
          ${CMAKE_CURRENT_LIST_DIR}/overload.cpp
  PUBLIC cairn_hal)
