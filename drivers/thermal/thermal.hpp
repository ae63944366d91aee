// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/camera/frame.hpp"
#include "drivers/thermal/config.hpp"
#include "drivers/thermal/models.hpp"
#include "drivers/thermal/stretch.hpp"
#include "drivers/thermal/telemetry.hpp"
#include "hal/ports.hpp"

namespace cairn::thermal {

/// 16-bit frames of a thermal camera → temperatures if the meaning of the counts is known, otherwise counts. Telemetry
/// rows behind the picture are removed. Those of a Lepton are read: they decide what a count means, whatever the
/// configuration says, and when a flat-field correction spoils the picture.
class Thermal final : public ThermalDecoder {
 public:
  /// What happened to the packets.
  struct Counters {
    std::uint64_t frames = 0;      ///< decoded
    std::uint64_t rejected = 0;    ///< malformed, of another size than the model's, or cut off by the transport
    std::uint64_t repeated = 0;    ///< the same packet again, or the camera's frame counter stood still
    std::uint64_t correcting = 0;  ///< frames with ThermalImage::correcting
  };
  /// For so long after a correction the picture may be wrong.
  static constexpr Duration kSettling = std::chrono::seconds(1);

  /// Error: kInvalidConfig.
  [[nodiscard]] static Result<Thermal> create(const Config& config);

  Result<const ThermalImage*> decode(const Packet& packet) override;

  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Of the last frame; none if it had no telemetry rows.
  [[nodiscard]] const std::optional<LeptonTelemetry>& telemetry() const { return telemetry_; }

 private:
  explicit Thermal(const Config& config);
  Result<bool> fill(const Packet& packet);
  Result<void> split(const camera::Frame& frame, ImageView& picture);
  Result<void> read_telemetry(const ImageView& rows);
  [[nodiscard]] std::optional<Scale> scale() const;
  [[nodiscard]] bool is_correcting(Time stamp);
  void fill_values(const ImageView& counts, const std::optional<Scale>& scale);

  Config config_;
  const Model* model_;
  Stretch stretch_;
  ThermalImage image_;
  std::optional<LeptonTelemetry> telemetry_;
  std::optional<std::uint64_t> last_sequence_;
  std::optional<std::uint32_t> last_counter_;
  std::optional<Time> corrected_;  // stamp of the last frame that told of a correction
  Counters counters_;
};

}  // namespace cairn::thermal
