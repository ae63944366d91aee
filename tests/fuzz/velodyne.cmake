# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(velodyne_data velodyne_data_fuzz.cpp LINK cairn_velodyne)
cairn_fuzz(velodyne_position velodyne_position_fuzz.cpp LINK cairn_velodyne)
cairn_fuzz(pcap_frame pcap_frame_fuzz.cpp LINK cairn_velodyne)
cairn_fuzz(pcap_file pcap_file_fuzz.cpp LINK cairn_velodyne)
