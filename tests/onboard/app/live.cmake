# SPDX-License-Identifier: Apache-2.0
cairn_test(live
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/live_server_test.cpp ${CMAKE_CURRENT_LIST_DIR}/live_view_test.cpp
  LINK cairn_live)
