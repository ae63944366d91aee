# SPDX-License-Identifier: Apache-2.0
cairn_bench(odometry SOURCES odometry_bench.cpp LINK cairn_odometry cairn_velodyne)
cairn_quality(odometry_accuracy SOURCES odometry_accuracy.cpp LINK cairn_odometry)
if(embree_FOUND)  # its recordings' wheels are those of the simulator
  cairn_quality(odometry_drives SOURCES odometry_drives.cpp LINK cairn_odometry cairn_velodyne cairn_recording cairn_simulator)
  cairn_quality(stereo_depth SOURCES flights/stereo_depth.cpp LINK cairn_app cairn_report cairn_simulator opencv::imgcodecs opencv::core)
endif()
cairn_quality(odometry_delays SOURCES odometry_delays.cpp LINK cairn_odometry cairn_velodyne cairn_recording)
cairn_quality(visual_accuracy SOURCES flights/visual_accuracy.cpp LINK cairn_visual_odometry cairn_app opencv::imgcodecs opencv::imgproc opencv::core)
cairn_quality(lidar_landmarks SOURCES flights/lidar_landmarks.cpp LINK cairn_visual_odometry cairn_app cairn_commands opencv::core)
