# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(live_view live_view_fuzz.cpp LINK cairn_live cairn_cli_top)
cairn_fuzz(saved_scans saved_scans_fuzz.cpp LINK cairn_generations PkgConfig::XXHASH)
cairn_fuzz(saved_state saved_state_fuzz.cpp LINK cairn_generations)
cairn_fuzz(schedule_log schedule_log_fuzz.cpp LINK cairn_scheduler)
