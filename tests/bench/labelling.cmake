# SPDX-License-Identifier: Apache-2.0
cairn_bench(labelling SOURCES labelling_bench.cpp LINK cairn_labelling)
