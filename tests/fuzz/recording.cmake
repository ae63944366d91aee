# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(recording_index recording_index_fuzz.cpp LINK cairn_recording)
cairn_fuzz(trajectory trajectory_fuzz.cpp LINK cairn_recording)
cairn_fuzz(pcd pcd_fuzz.cpp LINK cairn_recording)
cairn_fuzz(scan_file scan_file_fuzz.cpp LINK cairn_recording)
