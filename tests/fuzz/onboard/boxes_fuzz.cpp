// SPDX-License-Identifier: Apache-2.0
// Any text as boxes.csv: what was read is in order, names classes that exist, and survives being written and read
// again.
#include <string>

#include "onboard/perception/networks/recorded/box_file.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  using namespace cairn::networks;
  std::vector<RecordedBoxes> pictures, again;
  static_cast<void>(parse_boxes({reinterpret_cast<const char*>(data), size}, "fuzz", pictures));
  std::string written(kBoxHeader);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    require(i == 0 || pictures[i - 1].stamp <= pictures[i].stamp);
    for (const Detection& d : pictures[i].found)
      require(d.class_id < kSemanticClasses.size() && d.score >= 0 && d.score <= 1);
    written += to_csv(pictures[i]);
  }
  require(parse_boxes(written, "written", again).has_value());
  require(again.size() == pictures.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    require(again[i].stamp == pictures[i].stamp && again[i].camera == pictures[i].camera);
    require(again[i].found.size() == pictures[i].found.size());
    for (std::size_t k = 0; k < again[i].found.size(); ++k)
      require(again[i].found[k].width == pictures[i].found[k].width);
  }
  return 0;
}
