# SPDX-License-Identifier: Apache-2.0
cairn_bench(odometry SOURCES odometry_bench.cpp LINK cairn_odometry cairn_velodyne)
add_executable(odometry_accuracy odometry_accuracy.cpp)
target_link_libraries(odometry_accuracy PRIVATE cairn_flags cairn_places cairn_odometry)
