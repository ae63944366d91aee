// SPDX-License-Identifier: Apache-2.0
// A label image to the points of a scan, whole: projection, occlusion, borders, weights. 26 000 points all around, as
// of a VLP-16; a ZED's eye, which sees about a quarter of them. Every point in the picture is the worst case.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "onboard/perception/labelling/point_labeller.hpp"

namespace {

using namespace cairn;
using namespace cairn::labelling;

constexpr std::size_t kPoints = 26'000, kRings = 16;

/// Walls at changing distances, `share` of the full circle around the view.
PlacedScan walls(double share) {
  PlacedScan scan;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double turn = static_cast<double>(i / kRings) / (static_cast<double>(kPoints) / kRings) - 0.5;
    const double azimuth = 2 * 3.14159265 * share * turn;
    const double elevation = (static_cast<double>(i % kRings) - 8) * 0.035 * (share < 1 ? 0.6 : 1);
    const double range = 8 + 4 * std::sin(9 * azimuth) + (i / 200 % 3 == 0 ? 5 : 0);
    scan.points_base.emplace_back(static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)),
                                  static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)),
                                  static_cast<float>(range * std::sin(elevation)));
  }
  return scan;
}

LabelImage stripes(int width, int height) {
  LabelImage labels;
  labels.resize(width, height);
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    labels.classes[i] = static_cast<std::uint8_t>(i % static_cast<std::size_t>(width) / 40 % 10);
    labels.probabilities[i] = 220;
  }
  return labels;
}

void label(benchmark::State& state, double share, double line_time_us, cameras::DistortionModel model) {
  cameras::CameraParameters lens{
      .width = 672, .height = 376, .fx = 350, .fy = 350, .cx = 335.5, .cy = 187.5, .distortion = {}};
  lens.distortion = {model, {-0.04, 0.01}};
  LabellingConfig config;
  config.line_time_us = line_time_us;
  PointLabeller labeller(*cameras::CameraModel::create(lens), SE3(), config);
  const PlacedScan scan = walls(share);
  const LabelImage labels = stripes(336, 188);
  std::vector<LabelledPoint> out;
  Exposure exposure;
  exposure.twist << 1, 0, 0, 0, 0, 0.5;
  for (auto _ : state) {
    const auto figures = labeller.label(labels, scan, exposure, out);
    if (!figures) state.SkipWithError("refused");
    state.counters["seen"] = static_cast<double>(figures->seen);
    state.counters["labelled"] = static_cast<double>(figures->labelled);
  }
}

using cameras::DistortionModel;
BENCHMARK_CAPTURE(label, all_around, 1.0, 0, DistortionModel::kRadTan)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(label, all_in_picture, 0.2, 0, DistortionModel::kRadTan)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(label, all_in_picture_rolling, 0.2, 30, DistortionModel::kRadTan)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(label, all_in_picture_fisheye, 0.2, 0, DistortionModel::kEquidistant)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
