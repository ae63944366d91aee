// SPDX-License-Identifier: Apache-2.0
#include "tools/python/robot.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "drivers/camera/convert.hpp"
#include "drivers/camera/frame.hpp"
#include "hal/clock.hpp"
#include "hal/image.hpp"
#include "tools/python/pixels.hpp"

namespace cairn::python {
namespace {

using client::Costmap;
using client::CostmapConfig;
using clients::Stream;

constexpr std::array<std::pair<std::string_view, Stream>, 12> kStreams{{{"pose", Stream::kPose},
                                                                        {"state", Stream::kState},
                                                                        {"own_map", Stream::kOwnTiles},
                                                                        {"team_map", Stream::kTeamTiles},
                                                                        {"scan", Stream::kScan},
                                                                        {"events", Stream::kEvents},
                                                                        {"people", Stream::kPeople},
                                                                        {"team_people", Stream::kTeamPeople},
                                                                        {"cameras", Stream::kCameras},
                                                                        {"pictures", Stream::kPictures},
                                                                        {"wheels", Stream::kWheels},
                                                                        {"thermal", Stream::kThermal}}};
constexpr Duration kGlance = std::chrono::milliseconds(100);  // how long Ctrl-C may have to wait

Stream stream_of(const std::string& name) {
  std::string names;
  for (const auto& [known, stream] : kStreams) {
    if (known == name) return stream;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw py::value_error("there is no stream '" + name + "'; there are " + names);
}

client::RobotStream connect(const std::filesystem::path& socket, const std::vector<std::string>& streams,
                            const Rates& rates) {
  client::SubscribeMessage wants;
  for (const std::string& name : streams) wants.add(stream_of(name));
  if (wants.wants(Stream::kPictures)) wants.add(Stream::kCameras);  // a picture has the name of its camera
  for (const double hz : {rates.pose_hz, rates.scan_hz, rates.picture_hz})
    if (!(hz >= 0 && hz <= client::SubscribeMessage::kMaxPose_hz))
      throw py::value_error("pose_hz, scan_hz, picture_hz: 0 to 200");
  wants.pose_hz = rates.pose_hz;
  wants.scan_hz = rates.scan_hz;
  wants.picture_hz = static_cast<float>(rates.picture_hz);
  return value_of(client::RobotStream::connect(socket, wants));
}

}  // namespace

Robot::Robot(const std::filesystem::path& socket, const std::vector<std::string>& streams, const Rates& rates)
    : stream_(connect(socket, streams, rates)) {}

py::object Robot::next(double timeout_s) {
  if (!(timeout_s >= 0)) throw py::value_error("timeout: 0 s or more");
  const LiveClock clock;
  // A century: sums of times must not overflow.
  const Time until = clock.now() + from_seconds(std::min(timeout_s, 3e9));
  for (;;) {
    const Duration left = std::max(until - clock.now(), Duration::zero());
    auto message = [&] {
      const py::gil_scoped_release others_run;
      return stream_.next(std::min(left, kGlance));
    }();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    py::object found = take(value_of(std::move(message)));
    if (!found.is_none() || left == Duration::zero()) return found;
  }
}

py::object Robot::next_or_end() {
  for (;;) {
    py::object message = next(1);
    if (py::isinstance<client::CoreGone>(message)) throw py::stop_iteration();
    if (!message.is_none()) return message;
  }
}

py::object Robot::take(client::StreamMessage message) {
  if (std::holds_alternative<std::monostate>(message)) return py::none();
  if (const auto* tiles = std::get_if<client::TilesMessage>(&message)) return py::cast(take(*tiles));
  if (const auto* picture = std::get_if<client::PictureMessage>(&message)) return py::cast(picture_of(*picture));
  if (const auto* camera = std::get_if<client::CameraMessage>(&message)) cameras_[camera->camera] = *camera;
  if (const auto* hello = std::get_if<client::HelloMessage>(&message)) take(*hello);
  if (const auto* pose = std::get_if<client::PoseMessage>(&message)) T_odom_base_ = pose->T_odom_base.mean;
  if (const auto* state = std::get_if<client::StateMessage>(&message)) T_team_odom_ = state->T_team_odom;
  return std::visit(
      [](auto& m) -> py::object {
        using Message = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<Message, std::monostate> || std::is_same_v<Message, client::TilesMessage> ||
                      std::is_same_v<Message, client::PictureMessage>) {
          return py::none();
        } else {
          return py::cast(std::move(m));
        }
      },
      message);
}

void Robot::take(const client::HelloMessage& hello) {
  const auto begin = [&](Mirror& mirror, Stream stream, clients::TileMap map) {
    if (stream_.wants().wants(stream) && (!mirror || mirror->map().getResolution() != hello.resolution_m))
      mirror.emplace(map, hello.resolution_m);
  };
  begin(own_, Stream::kOwnTiles, clients::TileMap::kOwn);
  begin(team_, Stream::kTeamTiles, clients::TileMap::kTeam);
}

MapChanged Robot::take(const client::TilesMessage& tiles) {
  const bool own = tiles.map == clients::TileMap::kOwn;
  auto& wants = stream_.wants();
  mirror(own ? own_ : team_, tiles, own ? wants.own : wants.team);
  return {own ? "own" : "team", tiles.tiles.size(), tiles.caught_up};
}

PyPicture Robot::picture_of(const client::PictureMessage& picture) const {
  const auto camera = cameras_.find(picture.camera);
  Image image;
  {
    const py::gil_scoped_release others_run;
    const auto frame = camera::parse_frame(picture.bytes);
    if (!frame) throw Failure(frame.error());
    if (const auto decoded = camera::to_image(*frame, image); !decoded) throw Failure(decoded.error());
  }
  return {camera == cameras_.end() ? "" : camera->second.name, nanoseconds(picture.stamp), to_pixels(image.view())};
}

void Robot::mirror(Mirror& mirror, const client::TilesMessage& tiles, client::SubscribeMessage::Resume& has) {
  if (!mirror) throw Failure({Errc::kMalformed, "tiles came before the core's greeting"});
  const auto taken = mirror->take(tiles);
  has = mirror->resume();
  if (taken) return;
  stream_.subscribe(stream_.wants());  // asks again for what was damaged
  throw Failure(taken.error());
}

Map Robot::copy_of(const Mirror& mirror, const char* stream) {
  if (mirror) return {std::make_shared<mapping::SemanticOcTree>(mirror->map())};
  throw Failure(
      {Errc::kNotFound, "no map yet", stream, {}, "ask for this stream, and call next() until MapChanged comes"});
}

Costmap Robot::costmap(const CostmapConfig& config) const {
  if (!own_ || !T_odom_base_)
    throw Failure({Errc::kNotFound,
                   "no map or no pose yet",
                   "costmap",
                   {},
                   "ask for the streams pose and own_map, and call next() until both have come"});
  const client::PlannerView view(*own_, team_ ? &*team_ : nullptr, T_team_odom_);
  const py::gil_scoped_release others_run;
  return client::make_costmap(view, *T_odom_base_, config);
}

namespace {

constexpr const char* kAboutConnect =
    "Reads a running core through its robot.sock. `streams` names what is wanted: pose, state, own_map, team_map, "
    "scan,\n"
    "events, people, team_people, cameras, pictures, wheels, thermal. `pose_hz`: predictions, too, so often a second "
    "(200 at "
    "most).\n"
    "`scan_hz` (of thermal clouds, too), `picture_hz`: at most so many a second; 0: all. Error: no core is there.";

py::array_t<std::uint8_t> cost_of(const Costmap& map) {
  return to_array(map.cost, {py::ssize_t{map.cells}, py::ssize_t{map.cells}});
}
py::array_t<float> ground_of(const Costmap& map) {
  return to_array(map.ground_m, {py::ssize_t{map.cells}, py::ssize_t{map.cells}});
}

void add_costmap(py::module_& module) {
  py::class_<Costmap>(module, "Costmap", "A square of odom with the cost of each cell, as Nav2's costmaps have it.")
      .def_readonly("resolution_m", &Costmap::resolution_m)
      .def_readonly("x_m", &Costmap::x_m, "of the lower corner, in odom")
      .def_readonly("y_m", &Costmap::y_m, "of the lower corner, in odom")
      .def_property_readonly(
          "cost", &cost_of, "uint8, shape (rows along y, columns along x): 0 free, 253 hits, 254 occupied, 255 unknown")
      .def_property_readonly("ground_m", &ground_of, "height of the ground in odom, NaN where none is reached");
}

Costmap costmap_of(const Robot& robot, double size_m, double height_m, double step_m, double inscribed_m,
                   double inflation_m, double base_height_m) {
  if (!(size_m > 0 && size_m <= 200)) throw py::value_error("size_m: above 0, 200 at most");
  CostmapConfig config;
  config.size_m = size_m;
  config.height_m = height_m;
  config.step_m = step_m;
  config.inscribed_m = inscribed_m;
  config.inflation_m = inflation_m;
  config.base_height_m = base_height_m;
  return robot.costmap(config);
}

}  // namespace

void add_robot(py::module_& module) {
  add_costmap(module);
  const CostmapConfig husky;
  py::class_<Robot>(module, "Robot", "A running core. Iterating over it gives its messages until it ends.")
      .def("next", &Robot::next, py::arg("timeout") = 1.0, "The next message, or None after so many seconds.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &Robot::next_or_end)
      .def_property_readonly("lost", &Robot::lost, "messages that this program was too slow for")
      .def_property_readonly("own_map", &Robot::own_map, "copy of what has come of the robot's own map, in odom")
      .def_property_readonly("team_map", &Robot::team_map, "the same of the team's map, in the team's frame")
      .def("costmap", &costmap_of, "What the robot can drive on. The own map outranks the team's.", py::kw_only(),
           py::arg("size_m") = husky.size_m, py::arg("height_m") = husky.height_m, py::arg("step_m") = husky.step_m,
           py::arg("inscribed_m") = husky.inscribed_m, py::arg("inflation_m") = husky.inflation_m,
           py::arg("base_height_m") = husky.base_height_m);
  module.def(
      "connect",
      [](const std::filesystem::path& socket, const std::vector<std::string>& streams, double pose_hz, double scan_hz,
         double picture_hz) {
        return std::make_unique<Robot>(socket, streams, Rates{pose_hz, scan_hz, picture_hz});
      },
      py::arg("socket") = client::kRobotSocket, py::arg("streams") = std::vector<std::string>{"pose", "state"},
      py::kw_only(), py::arg("pose_hz") = 0.0, py::arg("scan_hz") = 0.0, py::arg("picture_hz") = 0.0, kAboutConnect);
}

}  // namespace cairn::python
