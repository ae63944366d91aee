// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/sensor_figures.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "drivers/camera/camera.hpp"
#include "drivers/depth/depth_camera.hpp"
#include "drivers/gpio/line_event.hpp"
#include "drivers/thermal/thermal.hpp"
#include "tools/cli/inspect/figures/can_figures.hpp"
#include "tools/cli/inspect/figures/command_figures.hpp"
#include "tools/cli/inspect/figures/peer_figures.hpp"

namespace cairn::cli {
namespace {

using recording::SourceEntry;

/// What pictures have in common: sizes, and a number that two decodings of the same bytes share.
class PictureFigures {
 public:
  void add(const Image& image) {
    ++pictures_;
    sizes_.emplace(image.width, image.height);
    for (const std::byte b : image.bytes) digest_ = (digest_ ^ std::to_integer<std::uint64_t>(b)) * 0x100000001B3U;
  }
  [[nodiscard]] report::Json to_json() const {
    report::Json json{{"pictures", pictures_}, {"sizes", report::Json::array()}, {"digest", digest_}};
    for (const auto& [width, height] : sizes_)
      if (json["sizes"].size() < kMaxSizes)
        json["sizes"].push_back(std::to_string(width) + "x" + std::to_string(height));
    return json;
  }

 private:
  static constexpr std::size_t kMaxSizes = 8;
  std::uint64_t pictures_ = 0, digest_ = 0xCBF29CE484222325U;  // FNV-1a
  std::set<std::pair<int, int>> sizes_;
};

class CameraFigures final : public SensorFigures {
 public:
  explicit CameraFigures(camera::Camera decoder) : decoder_(std::move(decoder)) {}
  Result<const Scan*> take(const Packet& packet) override {
    const auto image = decoder_.decode(packet);
    if (!image) return image.error();
    pictures_.add(**image);
    return nullptr;
  }
  [[nodiscard]] report::Json to_json() const override {
    report::Json json = pictures_.to_json();
    const auto& c = decoder_.counters();
    json.update({{"rejected", c.rejected}, {"repeated", c.repeated}, {"lost", c.lost}});
    return json;
  }

 private:
  camera::Camera decoder_;
  PictureFigures pictures_;
};

class ThermalFigures final : public SensorFigures {
 public:
  explicit ThermalFigures(thermal::Thermal decoder) : decoder_(std::move(decoder)) {}
  Result<const Scan*> take(const Packet& packet) override {
    const auto image = decoder_.decode(packet);
    if (!image) return image.error();
    if (*image == nullptr) return nullptr;
    pictures_.add((*image)->values);
    if ((*image)->radiometric()) add_celsius((*image)->values);
    return nullptr;
  }
  [[nodiscard]] report::Json to_json() const override {
    report::Json json = pictures_.to_json();
    const auto& c = decoder_.counters();
    json.update({{"rejected", c.rejected}, {"repeated", c.repeated}, {"correcting", c.correcting}});
    json["radiometric"] = radiometric_;
    json["celsius"] = nullptr;
    if (radiometric_ > 0) json["celsius"] = {{"min", coldest_}, {"max", warmest_}};
    return json;
  }

 private:
  void add_celsius(const Image& image) {
    ++radiometric_;
    const ImageView view = image.view();
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        coldest_ = std::min(coldest_, view.at<float>(x, y));
        warmest_ = std::max(warmest_, view.at<float>(x, y));
      }
  }

  thermal::Thermal decoder_;
  PictureFigures pictures_;
  std::uint64_t radiometric_ = 0;
  float coldest_ = 1e9F, warmest_ = -1e9F;
};

class DepthFigures final : public SensorFigures {
 public:
  explicit DepthFigures(depth::DepthCamera decoder) : decoder_(std::move(decoder)) {}
  Result<const Scan*> take(const Packet& packet) override { return decoder_.decode(packet); }
  [[nodiscard]] report::Json to_json() const override {
    const auto& c = decoder_.counters();
    return {{"pictures", c.frames},
            {"rejected", c.rejected},
            {"pixels_without_measurement", c.invalid},
            {"pixels_out_of_range", c.gated}};
  }

 private:
  depth::DepthCamera decoder_;
};

class GpioFigures final : public SensorFigures {
 public:
  Result<const Scan*> take(const Packet& packet) override {
    const auto event = gpio::decode_event(packet);
    if (!event) return event.error();
    PerLine& line = lines_.at(static_cast<std::size_t>(event->line));
    line.rising += event->level ? 1 : 0;
    line.falling += event->level ? 0 : 1;
    line.level = event->level;
    return nullptr;
  }
  [[nodiscard]] report::Json to_json() const override {
    report::Json json = report::Json::object();
    for (std::size_t i = 0; i < gpio::kLines; ++i)
      if (const PerLine& l = lines_.at(i); l.level)
        json[std::string(gpio::name_of(static_cast<gpio::Line>(i)))] = {
            {"rising", l.rising}, {"falling", l.falling}, {"last_level", *l.level ? 1 : 0}};
    return json;
  }

 private:
  struct PerLine {
    std::uint64_t rising = 0, falling = 0;
    std::optional<bool> level;
  };
  std::array<PerLine, gpio::kLines> lines_;
};

using Made = Result<std::unique_ptr<SensorFigures>>;

template <class Figures, class Decoder>
Made around(Result<Decoder> decoder) {
  if (!decoder) return decoder.error();
  return std::unique_ptr<SensorFigures>(std::make_unique<Figures>(std::move(*decoder)));
}

Made make_thermal(const SourceEntry& entry) {
  thermal::Config config;
  if (!entry.model.empty()) config.model = entry.model;
  return around<ThermalFigures>(thermal::Thermal::create(config));
}

}  // namespace

Made make_sensor_figures(const SourceEntry& entry) {
  if (entry.kind == recording::kCamera) return around<CameraFigures>(camera::Camera::create({}));
  if (entry.kind == recording::kThermal) return make_thermal(entry);
  if (entry.kind == recording::kDepth) return around<DepthFigures>(depth::DepthCamera::create({}));
  if (entry.kind == recording::kGpio) return std::unique_ptr<SensorFigures>(std::make_unique<GpioFigures>());
  if (entry.kind == recording::kPeers) return std::unique_ptr<SensorFigures>(std::make_unique<PeerFigures>());
  if (entry.kind == recording::kCommands) return std::unique_ptr<SensorFigures>(std::make_unique<CommandFigures>());
  return std::unique_ptr<SensorFigures>(std::make_unique<CanFigures>());
}

}  // namespace cairn::cli
