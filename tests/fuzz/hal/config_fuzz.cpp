// SPDX-License-Identifier: Apache-2.0
// Any text is either a valid configuration or a list of faults; a valid one survives being written and read again.
#include <cstdlib>
#include <string_view>

#include "hal/config/config.hpp"

namespace {

struct Inner {
  double edge_m = 0.5;
  std::vector<double> pose{0, 0, 0};
};
struct Outer {
  bool on = false;
  int count = 1;
  std::string name = "robot", kind = "a";
  Inner inner;
};

void declare(cairn::config::Section& s, Inner& c) {
  s.number("edge_m", c.edge_m, {0.1, 5.0}, "m", "edge");
  s.numbers("pose", c.pose, {-10, 10}, "m", "pose");
}
void declare(cairn::config::Section& s, Outer& c) {
  s.flag("on", c.on, "a switch");
  s.integer("count", c.count, {0, 9}, "", "a count");
  s.text("name", c.name, "a name");
  s.choice("kind", c.kind, {"a", "b"}, "a kind");
  s.group("inner", c.inner, "a group");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  Outer first;
  cairn::config::Section section;
  declare(section, first);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (!cairn::config::parse(text, "fuzz", section)) return 0;
  const std::string written = cairn::config::to_yaml(section);
  Outer second;
  cairn::config::Section again;
  declare(again, second);
  if (!cairn::config::parse(written, "written", again) || cairn::config::to_yaml(again) != written) std::abort();
  return 0;
}
