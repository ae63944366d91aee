# SPDX-License-Identifier: Apache-2.0
cairn_bench(peers
  SOURCES peers_bench.cpp
  LINK cairn_team PkgConfig::ZSTD)
