# SPDX-License-Identifier: Apache-2.0
cairn_bench(peers
  SOURCES peers_bench.cpp
  LINK cairn_team PkgConfig::ZSTD)
add_executable(team_runs team_runs.cpp team/figures.cpp team/recorded_robot.cpp)
target_link_libraries(team_runs PRIVATE cairn_flags cairn_team cairn_app cairn_team_figures PkgConfig::XXHASH)
add_executable(core_with_peers core_with_peers.cpp)
target_link_libraries(core_with_peers PRIVATE cairn_flags cairn_team cairn_app cairn_peer_link)
