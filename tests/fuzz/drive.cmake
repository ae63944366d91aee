# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(candump candump_fuzz.cpp LINK cairn_drive)
cairn_fuzz(can_state can_state_fuzz.cpp LINK cairn_drive)
cairn_fuzz(can_drive can_drive_fuzz.cpp LINK cairn_drive)
