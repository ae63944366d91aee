# SPDX-License-Identifier: Apache-2.0
foreach(program IN ITEMS matching_protocol matching_evidence)
  add_executable(${program} ${program}.cpp)
  target_link_libraries(${program} PRIVATE cairn_flags cairn_matching)
  target_compile_definitions(${program} PRIVATE CAIRN_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
endforeach()
cairn_bench(merging SOURCES merging_bench.cpp LINK cairn_merging)
cairn_bench(features SOURCES features_bench.cpp LINK cairn_matching)
