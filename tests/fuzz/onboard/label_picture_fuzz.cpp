// SPDX-License-Identifier: Apache-2.0
// Any bytes as a picture of labels: what was read has only classes that exist, and survives being written and read
// again.
#include "onboard/perception/networks/recorded/label_picture.hpp"

#include <algorithm>

#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  LabelImage labels, again;
  if (!networks::decode_label_picture({reinterpret_cast<const std::byte*>(data), size}, labels)) return 0;
  require(labels.classes.size() == labels.index(0, labels.height) &&
          labels.probabilities.size() == labels.classes.size());
  require(std::all_of(labels.classes.begin(), labels.classes.end(),
                      [](std::uint8_t id) { return id < kSemanticClasses.size() || id == kNoClass; }));
  std::vector<std::byte> file;
  require(networks::encode_label_picture(labels, file).has_value());
  require(networks::decode_label_picture(file, again).has_value());
  require(again.classes == labels.classes && again.probabilities == labels.probabilities);
  return 0;
}
