# SPDX-License-Identifier: Apache-2.0
cairn_library(watchdog
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/sd_notify.cpp ${CMAKE_CURRENT_LIST_DIR}/watchdog.cpp
  PUBLIC cairn_hal cairn_failsafe)
