// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "hal/semantic_class.hpp"
#include "tools/python/arrays.hpp"

namespace cairn::python {
namespace {

constexpr const char* kAbout =
    "Reads what Cairn writes and what a running core says: maps, trajectories and recordings as numpy arrays, and the\n"
    "streams of robot.sock. Metres, radians, seconds; frames as REP-103 and REP-105 name them. See docs/python.md.";

void add_classes(py::module_& module) {
  py::list names;
  std::vector<std::uint8_t> colours;
  for (const SemanticClass& c : kSemanticClasses) {
    names.append(py::str(std::string(c.name)));
    colours.insert(colours.end(), {c.r, c.g, c.b});
  }
  module.attr("CLASSES") = py::tuple(names);
  module.attr("CLASS_COLOURS") = to_array(std::move(colours), {py::ssize_t{kSemanticClasses.size()}, 3});
  module.attr("NO_CLASS") = int{kNoClass};
}

}  // namespace

PYBIND11_MODULE(cairn, module) {
  module.doc() = kAbout;
  module.attr("__version__") = CAIRN_VERSION_STRING;
  py::register_exception<Failure>(module, "Error").doc() = "What went wrong, where, and what to do about it.";
  add_classes(module);
  add_maps(module);
  add_recordings(module);
  add_messages(module);
  add_robot(module);
}

}  // namespace cairn::python
