# SPDX-License-Identifier: Apache-2.0
add_executable(matching_protocol matching_protocol.cpp)
target_link_libraries(matching_protocol PRIVATE cairn_flags cairn_matching)
target_compile_definitions(matching_protocol PRIVATE CAIRN_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
