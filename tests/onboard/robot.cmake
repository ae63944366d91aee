# SPDX-License-Identifier: Apache-2.0
cairn_test(robot SOURCES ${CMAKE_CURRENT_LIST_DIR}/resume_test.cpp LINK cairn_robot cairn_generations)
