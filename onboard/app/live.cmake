# SPDX-License-Identifier: Apache-2.0
cairn_library(live
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/live_server.cpp ${CMAKE_CURRENT_LIST_DIR}/live_view.cpp
  PUBLIC cairn_hal
  PRIVATE nlohmann_json::nlohmann_json)
