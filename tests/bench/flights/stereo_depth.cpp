// SPDX-License-Identifier: Apache-2.0
// How far off the points of dense stereo are, and how good a map they make: simulated flights against the scene that
// they were drawn from. Poses are the true ones, so nothing of odometry's error is in the figures.
//   stereo_depth RECORDING… [KEY=VALUE …]
// DenseStereoConfig's keys, and: resolution=0.2 (m, of the map); seconds=60 (of the flight); every=3 (pictures).
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <span>

#include "drivers/recording/formats/recording.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/perception/stereo/dense_stereo.hpp"
#include "onboard/report/figures/map_error.hpp"
#include "tests/bench/flights/recorded_flight.hpp"
#include "tools/simulator/scenes/make_world.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::stereo {
namespace {

namespace fs = std::filesystem;

constexpr double kFarthest_m = 100;  // that the scene is traced
constexpr int kTracedEvery = 5;      // clouds

struct Settings {
  std::vector<std::string> dense;  // as KEY: VALUE
  double resolution_m = 0.2, seconds = std::numeric_limits<double>::infinity();
  std::size_t every = 3;
};

/// Points whose true depth lies between two whole metres.
struct Errors {
  std::vector<double> px;  // of the disparity
  std::size_t off_02 = 0, off_04 = 0;
};
using ByDepth = std::map<int, Errors>;

double percentile(std::vector<double>& values, double share) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, nth);
  return *nth;
}

/// Compares points of the optical frame with what their pixels show.
void compare(const simulator::Tracer& tracer, const SE3& T_world_eye, const StereoGeometry& g,
             std::span<const Eigen::Vector3f> points, ByDepth& errors) {
  for (const Eigen::Vector3f& found : points) {
    const Eigen::Vector3d p = found.cast<double>(), ray = p.normalized();
    const auto hit = tracer.trace({T_world_eye.translation(), T_world_eye.rotation() * ray}, 0.05, kFarthest_m);
    const double z = hit ? hit->distance * ray.z() : kFarthest_m;
    Errors& e = errors[std::min(static_cast<int>(z), 10)];
    e.px.push_back(g.fx * g.baseline_m * (1 / p.z() - 1 / z));
    e.off_02 += std::abs(p.z() - z) > 0.2 ? 1 : 0;
    e.off_04 += std::abs(p.z() - z) > 0.4 ? 1 : 0;
  }
}

void print(ByDepth& errors) {
  for (auto& [z, e] : errors) {
    const auto n = static_cast<double>(e.px.size());
    const double middle = percentile(e.px, 0.5), low = percentile(e.px, 0.16), high = percentile(e.px, 0.84);
    std::printf(
        "  %2d%s m: %8zu points, disparity median %+.3f px, 68 %% within %.3f, off by 0.2 m %4.1f %%, 0.4 m %4.1f %%\n",
        z, z == 10 ? "+" : " ", e.px.size(), middle, (high - low) / 2, 100 * static_cast<double>(e.off_02) / n,
        100 * static_cast<double>(e.off_04) / n);
  }
}

void print(const mapping::SemanticOcTree& map, const fs::path& recording) {
  const auto truth = mapping::load_map(recording / "world.ot");
  if (!truth) return (void)std::printf("  %s\n", to_string(truth.error()).c_str());
  for (const double tolerance : {map.getResolution(), std::sqrt(3.0) * map.getResolution()}) {
    const auto e = report::map_error(map, **truth, {.T_truth_map = SE3(), .tolerance_m = tolerance});
    if (!e) return (void)std::printf("  %s\n", to_string(e.error()).c_str());
    std::printf("  map: %zu voxels, %.1f %% within %.2f m, mean %.3f m; of what was seen, found %.1f %%\n",
                static_cast<std::size_t>(e->occupied), 100 * e->precision().value_or(0), tolerance, e->mean_m,
                100 * e->recall().value_or(0));
  }
}

/// The simulator notes the scene.
Result<simulator::World> world_of(const fs::path& recording) {
  const auto header = recording::load_recording(recording);
  if (!header) return header.error();
  for (const std::string& name : simulator::scene_names())
    if (header->notes.find("scene " + name) != std::string::npos) return simulator::make_world(name);
  return Error{Errc::kNotFound, "no simulated scene is noted", recording.string(), {}, {}};
}

/// One flight through a scene.
struct Flight {
  flights::Eyes eyes;
  simulator::Tracer tracer;
  flights::Truth truth;
  DenseStereo dense;
  mapping::Mapper mapper;
  ByDepth errors;
  StereoPair pair;
  std::vector<Eigen::Vector3f> points;
  double cpu_ms = 0;
  int clouds = 0;

  Result<void> look(std::int64_t ns, const fs::path& file) {
    const auto done = eyes.rectifier.rectify(flights::image_of(cv::imread(file, cv::IMREAD_COLOR), ns), pair);
    if (!done) return done.error();
    const Duration begin = thread_cpu_time();
    dense.measure(pair, eyes.profile.trust.max_range_m, points);
    cpu_ms += to_milliseconds(thread_cpu_time() - begin);
    const SE3 T_world_eye = truth.at(ns) * eyes.T_base_eye;
    if (clouds++ % kTracedEvery == 0) compare(tracer, T_world_eye, eyes.rectifier.geometry(), points, errors);
    for (Eigen::Vector3f& p : points) p = (T_world_eye * p.cast<double>()).cast<float>();
    const auto inserted = mapper.insert(points, T_world_eye.translation().cast<float>(), eyes.profile.trust);
    if (!inserted) return inserted.error();
    return {};
  }
};

Result<DenseStereoConfig> dense_config(DenseStereoConfig config, const Settings& settings) {
  for (const std::string& line : settings.dense) {
    config::Section section;
    declare(section, config);
    if (const auto parsed = config::parse(line, "arguments", section); !parsed) return parsed.error();
  }
  return config;
}

Result<void> run(const fs::path& recording, const Settings& settings) {
  auto eyes = flights::eyes_of(recording);
  if (!eyes) return eyes.error();
  const auto dense = dense_config(eyes->profile.dense, settings);
  if (!dense) return dense.error();
  const auto world = world_of(recording);
  if (!world) return world.error();
  auto tracer = simulator::Tracer::build(world->mesh);
  if (!tracer) return tracer.error();
  Workers workers(1);
  const StereoGeometry geometry = eyes->rectifier.geometry();
  Flight flight{std::move(*eyes),
                std::move(*tracer),
                flights::load_truth(recording / "ground_truth.tum"),
                {*dense, geometry},
                {{.resolution_m = settings.resolution_m}, workers},
                {},
                {},
                {}};
  const auto pictures = flights::pictures_of(recording);
  for (std::size_t i = 0; i < pictures.size(); i += settings.every) {
    const auto& [ns, file] = pictures[i];
    if (static_cast<double>(ns - pictures.front().first) * 1e-9 > settings.seconds) break;
    if (const auto done = flight.look(ns, file); !done) return done.error();
  }
  std::printf("%s: %d clouds, %.1f ms of CPU time each\n", recording.c_str(), flight.clouds,
              flight.cpu_ms / flight.clouds);
  print(flight.errors);
  print(flight.mapper.tree(), recording);
  return {};
}

bool set(const std::string& key, const std::string& value, Settings& s) {
  if (key == "resolution") return (s.resolution_m = std::stod(value)) > 0;
  if (key == "seconds") return (s.seconds = std::stod(value)) > 0;
  if (key == "every") return (s.every = std::stoul(value)) > 0;
  s.dense.push_back(key + ": " + value);
  return true;
}

}  // namespace

int main_program(std::span<char*> arguments) {
  Settings settings;
  std::vector<fs::path> recordings;
  const auto known = [&](const std::string& key, const std::string& value) { return set(key, value, settings); };
  if (!flights::read_arguments(arguments, recordings, known)) return 2;
  for (const fs::path& recording : recordings)
    if (const auto done = run(recording, settings); !done) {
      std::fprintf(stderr, "%s\n", to_string(done.error()).c_str());
      return 1;
    }
  return 0;
}

}  // namespace cairn::stereo

int main(int argc, char** argv) { return cairn::stereo::main_program({argv + 1, argv + argc}); }
