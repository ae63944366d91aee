// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::python {

namespace py = pybind11;

/// What Python sees as cairn.Error.
class Failure : public std::runtime_error {
 public:
  explicit Failure(const Error& error) : std::runtime_error(to_string(error)) {}
};

/// The value, or a Failure is thrown.
template <class T>
[[nodiscard]] T value_of(Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(*result);
}

/// A numpy array of this shape, in C order, that takes over the memory of `values`.
template <class T>
[[nodiscard]] py::array_t<T> to_array(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const T* data = kept->data();
  const py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  (void)kept.release();  // the capsule has it
  return py::array_t<T>(std::move(shape), data, owner);
}
/// The same with one dimension.
template <class T>
[[nodiscard]] py::array_t<T> to_array(std::vector<T> values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return to_array(std::move(values), {size});
}
/// Points as an array of shape (N, 3).
[[nodiscard]] inline py::array_t<float> to_array(const std::vector<Eigen::Vector3f>& points) {
  py::array_t<float> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  if (!points.empty()) std::copy_n(points.front().data(), 3 * points.size(), array.mutable_data());
  return array;
}

/// Python's whole numbers have no bound, so stamps keep their nanoseconds.
[[nodiscard]] inline std::int64_t nanoseconds(Time time) { return time.time_since_epoch().count(); }

/// What repr() of a message shows: its class and these of its properties, numbers of arrays to a thousandth.
[[nodiscard]] inline auto repr_of(std::vector<const char*> properties) {
  return [properties = std::move(properties)](const py::object& self) {
    std::string text = "cairn." + py::str(py::type::of(self).attr("__name__")).cast<std::string>() + "(";
    for (const char* property : properties) {
      py::object value = self.attr(property);
      if (py::isinstance<py::array>(value)) value = value.attr("round")(3).attr("tolist")();
      if (property != properties.front()) text += ", ";
      text += property + ("=" + py::repr(value).cast<std::string>());
    }
    return text + ")";
  };
}

// One function for each file of the module: adds its classes and functions.
void add_maps(py::module_& module);
void add_recordings(py::module_& module);
void add_messages(py::module_& module);
void add_robot(py::module_& module);

}  // namespace cairn::python
