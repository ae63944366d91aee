# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(map_pair map_pair_fuzz.cpp LINK cairn_matching cairn_merging)
if(CAIRN_FUZZ)
  # No comparison in here is with a magic number that the fuzzer could learn; watching them takes 60 % of its time.
  foreach(library cairn_matching cairn_merging)
    target_compile_options(${library} PRIVATE -fno-sanitize-coverage=trace-cmp)
  endforeach()
endif()
cairn_fuzz(peers peers_fuzz.cpp LINK cairn_peers)
cairn_fuzz(peers_log peers_log_fuzz.cpp LINK cairn_peer_link)
