// SPDX-License-Identifier: Apache-2.0
// mapping_lockstep FIRST COUNT: runs the scan cases with these seeds and names those in which Mapper and OctoMap
// differ.
#include <cstdio>
#include <cstdlib>

#include "tests/onboard/mapping/insert/scan_cases.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: %s FIRST COUNT\n", argv[0]), 2;
  const auto first = static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10));
  const auto count = static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10));
  unsigned failed = 0;
  for (unsigned seed = first; seed < first + count; ++seed) {
    const std::string fault = cairn::mapping::ScanCase(seed, 12).run(1 + seed % 3);
    if (fault.empty()) continue;
    ++failed;
    std::printf("seed %u: %s\n", seed, fault.c_str());
  }
  std::printf("%u seeds, %u failed\n", count, failed);
  return failed == 0 ? 0 : 1;
}
