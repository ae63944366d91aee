# SPDX-License-Identifier: Apache-2.0
cairn_bench(labelling SOURCES labels/labelling_bench.cpp LINK cairn_labelling)
if(embree_FOUND)  # its recordings are the simulator's
  cairn_quality(labelling_accuracy SOURCES labels/labelling_accuracy.cpp
    LINK cairn_app cairn_labelling cairn_networks cairn_recording cairn_simulator cairn_velodyne)
  cairn_quality(label_fusion SOURCES labels/label_fusion.cpp
    LINK cairn_app cairn_labelling cairn_networks cairn_recording cairn_simulator cairn_velodyne cairn_report)
endif()
