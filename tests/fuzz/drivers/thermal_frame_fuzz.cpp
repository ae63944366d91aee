// SPDX-License-Identifier: Apache-2.0
// Any sequence of Lepton frames with any telemetry, and any bytes as packets: temperatures are finite and never appear
// where the camera says that its counts are none; what is marked is what the camera told.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "drivers/thermal/thermal.hpp"
#include "hal/bytes.hpp"

namespace {

using namespace cairn;
using namespace cairn::thermal;

void require(bool property) {
  if (!property) std::abort();
}

void check(const Thermal& decoder, const ThermalImage& image) {
  require(image.stretched.width == image.values.width && image.stretched.height == image.values.height);
  require(image.stretched.bytes.size() == image.stretched.stride * static_cast<std::size_t>(image.stretched.height));
  const auto& telemetry = decoder.telemetry();
  if (telemetry && (!telemetry->tlinear || telemetry->agc)) require(!image.radiometric());
  if (telemetry && telemetry->flat_field == FlatField::kRunning) require(image.correcting);
  if (!image.radiometric()) return;
  for (int x = 0; x < image.values.width; ++x) {
    const auto celsius = image.values.view().at<float>(x, 0);
    require(std::isfinite(celsius) && celsius >= -273.16F && celsius < 6300);
  }
}

/// Made once: under AddressSanitizer making a decoder takes longer than a hundred frames. What one remembers of the
/// input before touches no property that is checked here.
Thermal& decoder_for(unsigned choice) {
  static const auto make = [](const char* model, const char* units) {
    Config config;
    config.model = model;
    config.units = units;
    return Thermal::create(config).value();
  };
  static std::array decoders{make("plain", "centikelvin"), make("lepton2", "centikelvin"), make("plain", "auto"),
                             make("lepton2", "auto")};
  return decoders[choice % 4];
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  ByteReader in({reinterpret_cast<const std::byte*>(data), size});
  const auto choice = in.read<std::uint8_t>();
  if (!choice) return 0;
  Thermal& decoder = decoder_for(*choice);
  static std::uint64_t sequence = 0;
  Packet packet;
  packet.sequence = ++sequence;
  Time arrival{};
  if ((*choice & 4U) != 0) {  // the rest is one packet, header and all
    const auto rest = in.read_bytes(in.remaining()).value();
    packet.bytes.assign(rest.begin(), rest.end());
    if (const auto image = decoder.decode(packet); image && *image != nullptr) check(decoder, **image);
    return 0;
  }
  int frames = 0;
  for (auto step = in.read<std::uint8_t>(); step && frames < 3; step = in.read<std::uint8_t>()) {
    packet.bytes.clear();
    camera::append_header(packet.bytes, {camera::fourcc("Y16 "), 80, 63, 160, false});
    packet.bytes.resize(packet.bytes.size() + 80 * 63 * 2, std::byte{0x70});
    const auto rows = in.read_bytes(std::min(kTelemetryBytes, in.remaining())).value();
    std::copy(rows.begin(), rows.end(), packet.bytes.end() - static_cast<std::ptrdiff_t>(kTelemetryBytes));
    ++frames;
    packet.sequence = ++sequence;
    packet.arrival = arrival += std::chrono::milliseconds(*step);
    if (const auto image = decoder.decode(packet); image && *image != nullptr) check(decoder, **image);
  }
  return 0;
}
