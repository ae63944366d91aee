# SPDX-License-Identifier: Apache-2.0
cairn_bench(velodyne SOURCES velodyne_bench.cpp LINK cairn_velodyne)
