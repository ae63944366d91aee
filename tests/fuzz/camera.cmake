# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(camera_frame camera_frame_fuzz.cpp LINK cairn_camera)
cairn_fuzz(picture_file picture_file_fuzz.cpp LINK cairn_camera)
cairn_fuzz(npy npy_fuzz.cpp LINK cairn_camera)
cairn_fuzz(thermal_frame thermal_frame_fuzz.cpp LINK cairn_thermal)
cairn_fuzz(lepton_telemetry lepton_telemetry_fuzz.cpp LINK cairn_thermal)
cairn_fuzz(depth_frame depth_frame_fuzz.cpp LINK cairn_depth)
cairn_fuzz(image_index image_index_fuzz.cpp LINK cairn_recording)
