# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(map_pair map_pair_fuzz.cpp LINK cairn_matching cairn_merging)
