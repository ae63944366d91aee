# SPDX-License-Identifier: Apache-2.0
cairn_bench(mapping
  SOURCES mapping_bench.cpp ${PROJECT_SOURCE_DIR}/tests/onboard/mapping/allocation_count.cpp
  LINK cairn_mapping)
