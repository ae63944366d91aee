# SPDX-License-Identifier: Apache-2.0
foreach(program IN ITEMS matching_protocol matching_evidence)
  cairn_quality(${program} SOURCES ${program}.cpp LINK cairn_protocol)
endforeach()
cairn_quality(matching_unlike SOURCES matching_unlike.cpp ${CMAKE_SOURCE_DIR}/tools/protocol/methods/starts.cpp
  LINK cairn_matching cairn_recording)
cairn_bench(merging SOURCES merging_bench.cpp LINK cairn_merging)
cairn_bench(features SOURCES features_bench.cpp LINK cairn_matching)
if(embree_FOUND)
  add_library(missions STATIC missions/building.cpp missions/explorer.cpp)
  target_link_libraries(missions PUBLIC cairn_flags cairn_matching cairn_simulator)
  foreach(program IN ITEMS matching_missions matching_covariance matching_global map_check)
    cairn_quality(${program} SOURCES ${program}.cpp LINK missions cairn_merging)
  endforeach()
  cairn_quality(matching_pairs SOURCES matching_pairs.cpp
    pairs/calibration.cpp pairs/chart.cpp pairs/grounds.cpp pairs/results.cpp pairs/survey.cpp LINK missions)
endif()
