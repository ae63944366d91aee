# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(map_cairn map_cairn_fuzz.cpp LINK cairn_mapping PkgConfig::ZSTD)
cairn_fuzz(map_ot map_ot_fuzz.cpp LINK cairn_mapping)
cairn_fuzz(map_bt map_bt_fuzz.cpp LINK cairn_mapping)
