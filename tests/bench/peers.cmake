# SPDX-License-Identifier: Apache-2.0
cairn_bench(peers
  SOURCES peers_bench.cpp
  LINK cairn_team PkgConfig::ZSTD)
cairn_quality(team_runs
  SOURCES team_runs.cpp team/figures.cpp team/recorded_robot.cpp
  LINK cairn_team cairn_app cairn_team_figures PkgConfig::XXHASH)
cairn_quality(submap_drift SOURCES team/submap_drift.cpp LINK cairn_app cairn_peers)
cairn_quality(core_with_peers SOURCES core_with_peers.cpp LINK cairn_team cairn_app cairn_peer_link)
cairn_quality(core_with_clients SOURCES core_with_clients.cpp LINK cairn_app cairn_client)
find_package(fastcdr QUIET)
find_package(fastrtps QUIET)
if(fastrtps_FOUND AND fastcdr_FOUND)
  cairn_quality(ros_drive SOURCES ros/ros_drive.cpp LINK cairn_recording fastrtps fastcdr octomap octomath)
endif()
