// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "onboard/client/robot_stream.hpp"
#include "tools/python/arrays.hpp"
#include "tools/python/map_changed.hpp"

namespace cairn::python {
namespace {

using client::CameraMessage;
using client::EventMessage;
using client::HelloMessage;
using client::PeopleMessage;
using client::PoseMessage;
using client::ScanMessage;
using client::StateMessage;
using client::ThermalMessage;
using client::WheelsMessage;
using Person = PeopleMessage::Person;

constexpr const char* kStamp = "robot time; with Hello.realtime_offset_ns added it is UTC";
constexpr const char* kEpoch = "counts maps: poses of two epochs must not be compared";

/// The stamp of a message.
template <class Message>
std::int64_t stamp_of(const Message& message) {
  return nanoseconds(message.stamp);
}

void add_hello(py::module_& module) {
  py::class_<HelloMessage>(module, "Hello", "The first message of a core: who it is.")
      .def_readonly("robot", &HelloMessage::robot)
      .def_readonly("robot_id", &HelloMessage::robot_id, "in its team; 0: it is in none")
      .def_readonly("resolution_m", &HelloMessage::resolution_m, "edge of a voxel of its maps")
      .def_property_readonly("realtime_offset_ns", [](const HelloMessage& m) { return m.realtime_offset.count(); })
      .def_property_readonly(
          "T_base_sensor",
          [](const HelloMessage& m) {
            py::dict poses;
            for (const auto& sensor : m.sensors) poses[py::str(sensor.name)] = sensor.T_base_sensor.matrix();
            return poses;
          },
          "pose of each sensor in base_link by name, shape (4, 4), m")
      .def("__repr__", repr_of({"robot", "robot_id", "resolution_m"}));
}

void add_pose(py::module_& module) {
  py::class_<PoseMessage>(module, "Pose", "Where the robot is.")
      .def_property_readonly("stamp_ns", &stamp_of<PoseMessage>, kStamp)
      .def_property_readonly(
          "xyz", [](const PoseMessage& m) { return m.T_odom_base.mean.translation(); }, "in odom, m")
      .def_property_readonly(
          "quaternion_xyzw",
          [](const PoseMessage& m) -> Eigen::Vector4d { return m.T_odom_base.mean.quaternion().coeffs(); })
      .def_property_readonly(
          "T_odom_base", [](const PoseMessage& m) { return m.T_odom_base.mean.matrix(); }, "(4, 4)")
      .def_property_readonly(
          "covariance", [](const PoseMessage& m) { return m.T_odom_base.covariance; },
          "of x, y, z, and about x, y, z, in base_link; m, rad; shape (6, 6)")
      .def_property_readonly(
          "twist", [](const PoseMessage& m) { return m.twist; },
          "of base_link in base_link: m/s, then rad/s; shape (6,)")
      .def_readonly("epoch", &PoseMessage::epoch, kEpoch)
      .def_readonly("predicted", &PoseMessage::predicted, "not of a scan: the last one, moved on")
      .def_readonly("lost", &PoseMessage::lost, "the last scan did not fit: the pose says little")
      .def_readonly("degenerate_directions", &PoseMessage::degenerate_directions, "that the last scan left open")
      .def("__repr__", repr_of({"stamp_ns", "xyz", "epoch", "predicted", "lost"}));
}

void add_state(py::module_& module) {
  py::class_<StateMessage>(module, "State", "How the robot is: sent with every change, and once a second.")
      .def_property_readonly("stamp_ns", &stamp_of<StateMessage>, kStamp)
      .def_property_readonly(
          "mode", [](const StateMessage& m) { return std::string(to_string(m.mode)); },
          "normal, degraded, hold or stop")
      .def_readonly("cause", &StateMessage::cause, "code of the fault that the mode has; empty: none")
      .def_readonly("faults", &StateMessage::faults, "codes of what is wrong now, as in docs/faults.md")
      .def_readonly("shed", &StateMessage::shed, "work that is left out under overload")
      .def_readonly("scans", &StateMessage::scans, "so far")
      .def_property_readonly(
          "T_team_odom",
          [](const StateMessage& m) -> std::optional<Eigen::Matrix4d> {
            if (!m.T_team_odom) return std::nullopt;
            return m.T_team_odom->matrix();
          },
          "where odom lies in the frame of the team, shape (4, 4); None: not known")
      .def("__repr__", repr_of({"stamp_ns", "mode", "cause", "faults", "scans"}));
}

void add_scan(py::module_& module) {
  py::class_<ScanMessage>(module, "Scan", "A scan that has been located.")
      .def_property_readonly("stamp_ns", &stamp_of<ScanMessage>, kStamp)
      .def_property_readonly(
          "T_odom_base", [](const ScanMessage& m) { return m.T_odom_base.matrix(); }, "(4, 4)")
      .def_property_readonly(
          "xyz", [](const ScanMessage& m) { return to_array(m.points_base); },
          "deskewed points in base_link, m; float32, shape (N, 3)")
      .def_readonly("epoch", &ScanMessage::epoch, kEpoch)
      .def_readonly("lost", &ScanMessage::lost, "the pose is only a prediction")
      .def("__repr__", repr_of({"stamp_ns", "epoch", "lost"}));
}

/// Columns `first` to `first + count` of x y z value, shape (N, count).
py::array_t<float> columns_of(const ThermalMessage& cloud, std::size_t first, std::size_t count) {
  std::vector<float> numbers;
  numbers.reserve(count * cloud.points.size());
  for (const ThermalPoint& p : cloud.points) {
    const std::array<float, 4> row{p.point_base.x(), p.point_base.y(), p.point_base.z(), p.value};
    numbers.insert(numbers.end(), row.begin() + static_cast<std::ptrdiff_t>(first),
                   row.begin() + static_cast<std::ptrdiff_t>(first + count));
  }
  const auto points = static_cast<py::ssize_t>(cloud.points.size());
  if (count == 1) return to_array(std::move(numbers), {points});
  return to_array(std::move(numbers), {points, static_cast<py::ssize_t>(count)});
}

void add_thermal(py::module_& module) {
  py::class_<ThermalMessage>(module, "ThermalCloud", "What the thermal camera measured at the points of a scan.")
      .def_property_readonly("stamp_ns", &stamp_of<ThermalMessage>, "of the picture, in robot time")
      .def_property_readonly(
          "T_odom_base", [](const ThermalMessage& m) { return m.T_odom_base.matrix(); }, "(4, 4)")
      .def_property_readonly(
          "xyz", [](const ThermalMessage& m) { return columns_of(m, 0, 3); },
          "points in base_link, m; float32, shape (N, 3)")
      .def_property_readonly(
          "value", [](const ThermalMessage& m) { return columns_of(m, 3, 1); },
          "deg C, or counts, of each point; float32, shape (N,)")
      .def_readonly("celsius", &ThermalMessage::celsius, "False: values are raw counts")
      .def_readonly("epoch", &ThermalMessage::epoch, kEpoch)
      .def("__repr__", repr_of({"stamp_ns", "epoch", "celsius"}));
}

void add_people(py::module_& module) {
  py::class_<Person>(module, "Person", "Somebody whom a robot follows.")
      .def_readonly("id", &Person::id)
      .def_readonly("sightings", &Person::sightings, "pictures in which a detector saw this person")
      .def_readonly("seen", &Person::seen, "in this scan; otherwise the place is predicted")
      .def_property_readonly(
          "xyz", [](const Person& p) { return p.position_odom; }, "on the ground, in odom, m")
      .def_property_readonly(
          "velocity", [](const Person& p) { return p.velocity_odom; }, "x and y in odom, m/s")
      .def_property_readonly(
          "covariance", [](const Person& p) { return p.covariance; }, "of x and y, m^2")
      .def("__repr__", repr_of({"id", "xyz", "velocity", "seen"}));
  py::class_<PeopleMessage>(module, "People", "The people around a robot, as one scan shows them.")
      .def_property_readonly("stamp_ns", &stamp_of<PeopleMessage>, kStamp)
      .def_readonly("robot", &PeopleMessage::robot, "the teammate who follows them; 0: this robot")
      .def_readonly("epoch", &PeopleMessage::epoch, kEpoch)
      .def_readonly("people", &PeopleMessage::people, "list of Person")
      .def("__repr__", repr_of({"stamp_ns", "robot", "people"}));
}

const char* lens_of(const CameraMessage& camera) {
  if (camera.lens == CameraMessage::Lens::kUnknown) return "unknown";
  return camera.lens == CameraMessage::Lens::kRadTan ? "radtan" : "equidistant";
}

Eigen::Matrix3d matrix_of(const CameraMessage& camera) {
  Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
  if (camera.lens != CameraMessage::Lens::kUnknown) k << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return k;
}

void add_camera(py::module_& module) {
  py::class_<CameraMessage>(module, "Camera", "A camera of the robot and how it sees.")
      .def_readonly("name", &CameraMessage::name, "as in Picture.sensor and Hello.T_base_sensor")
      .def_readonly("width", &CameraMessage::width, "pixels of one eye's picture")
      .def_readonly("height", &CameraMessage::height, "pixels")
      .def_readonly("side_by_side", &CameraMessage::side_by_side, "a picture holds both eyes, the left one first")
      .def_property_readonly("lens", &lens_of, "radtan, equidistant, or unknown: not calibrated")
      .def_property_readonly("K", &matrix_of, "of the left eye, pixels, shape (3, 3); zeros: not calibrated")
      .def_readonly("distortion", &CameraMessage::k, "eight numbers in OpenCV's order")
      .def_readonly("baseline_m", &CameraMessage::baseline_m, "from the left to the right eye; 0: not known")
      .def("__repr__", repr_of({"name", "width", "height", "lens"}));
}

void add_wheels(py::module_& module) {
  using Wheel = WheelsMessage::Wheel;
  py::class_<Wheel>(module, "Wheel", "What one wheel did.")
      .def_property_readonly(
          "place", [](const Wheel& w) { return std::string(to_string(w.place)); }, "left, right, front_left and so on")
      .def_readonly("travel_m", &Wheel::travel_m, "of its rim since the core began, forward")
      .def_readonly("speed_m_s", &Wheel::speed_m_s, "of its rim")
      .def("__repr__", repr_of({"place", "travel_m", "speed_m_s"}));
  py::class_<WheelsMessage>(module, "Wheels", "What the wheels measured.")
      .def_property_readonly("stamp_ns", &stamp_of<WheelsMessage>, kStamp)
      .def_readonly("v", &WheelsMessage::v, "of the robot by its wheels alone, m/s")
      .def_readonly("w", &WheelsMessage::w, "rad/s, to the left")
      .def_property_readonly(
          "covariance", [](const WheelsMessage& m) { return m.covariance; }, "of v and w")
      .def_readonly("slipping", &WheelsMessage::slipping, "the wheels contradict each other, or physics")
      .def_readonly("radius_m", &WheelsMessage::radius_m, "of a wheel; 0: the profile does not say it")
      .def_readonly("wheels", &WheelsMessage::wheels, "list of Wheel")
      .def("__repr__", repr_of({"stamp_ns", "v", "w", "slipping", "wheels"}));
}

void add_news(py::module_& module) {
  py::class_<EventMessage>(module, "Event", "Something that happened, and how often so far.")
      .def_property_readonly("stamp_ns", &stamp_of<EventMessage>, kStamp)
      .def_readonly("count", &EventMessage::count)
      .def_readonly("stage", &EventMessage::stage)
      .def_readonly("what", &EventMessage::what)
      .def("__repr__", repr_of({"stamp_ns", "stage", "what", "count"}));
  py::class_<MapChanged>(module, "MapChanged", "A part of a map has come; Robot.own_map or Robot.team_map has it.")
      .def_readonly("map", &MapChanged::map, "own or team")
      .def_readonly("tiles", &MapChanged::tiles, "how many tiles came")
      .def_readonly("caught_up", &MapChanged::caught_up, "there is nothing newer")
      .def("__repr__", repr_of({"map", "tiles", "caught_up"}));
  py::class_<client::CoreGone>(module, "CoreGone", "The core has ended. The next message is of the core that follows.")
      .def("__repr__", repr_of({}));
}

}  // namespace

void add_messages(py::module_& module) {
  add_hello(module);
  add_pose(module);
  add_state(module);
  add_scan(module);
  add_thermal(module);
  add_people(module);
  add_camera(module);
  add_wheels(module);
  add_news(module);
}

}  // namespace cairn::python
