# SPDX-License-Identifier: Apache-2.0
cairn_bench(mapping
  SOURCES mapping_bench.cpp ../support/allocation_count.cpp
  LINK cairn_mapping)
cairn_bench(labels
  SOURCES labels/labels_bench.cpp
  LINK cairn_mapping)
