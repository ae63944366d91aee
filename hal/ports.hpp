// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hal/geo_fix.hpp"
#include "hal/image.hpp"
#include "hal/labels.hpp"
#include "hal/packet.hpp"
#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn {

/// What Source::next() did.
enum class Poll : std::uint8_t {
  kPacket,   ///< the packet was filled
  kTimeout,  ///< nothing came in time; call again
  kEnd,      ///< the recording ended; nothing more will come
};

/// The port through which all bytes enter: a live device, or its recording.
class Source {
 public:
  virtual ~Source() = default;
  /// Fills `packet` and reuses its memory. Waits at most `timeout`. An Error concerns this packet, not the source: the
  /// caller may go on calling, and gets kEnd when nothing can follow.
  virtual Result<Poll> next(Packet& packet, Duration timeout) = 0;

 protected:
  Source() = default;
  Source(const Source&) = default;
  Source& operator=(const Source&) = default;
};

/// Bytes → scans. Pure: no device, no clock, no file.
class ScanDecoder {
 public:
  virtual ~ScanDecoder() = default;
  /// Consumes one packet. Returns the scan that it completed, or null. The scan is the decoder's and stays valid until
  /// the next call. An Error means that this packet was refused whole. Decoding goes on with the next one.
  virtual Result<const Scan*> decode(const Packet& packet) = 0;
  /// Closes the running scan if it is too old at `now`, because the motor stopped or the link broke. Null if it is not.
  virtual const Scan* expire(Time now) = 0;
  /// Closes the running scan at the end of the data. Null if it is empty.
  virtual const Scan* flush() = 0;
  /// A pulse per second, which the sensor gets as well, rose at `at`. Pulses come for as long as they are regular.
  virtual void note_second(Time /*at*/) {}
  /// Where a satellite receiver that speaks through the sensor was, once for each fix. None: nothing new.
  virtual std::optional<GeoFix> take_fix() { return std::nullopt; }

 protected:
  ScanDecoder() = default;
  ScanDecoder(const ScanDecoder&) = default;
  ScanDecoder& operator=(const ScanDecoder&) = default;
};

/// Bytes → pictures, one for one. Pure: no device, no clock, no file.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// The picture is the decoder's and stays valid until the next call. An Error means that this packet was refused
  /// whole. Decoding goes on with the next one.
  virtual Result<const Image*> decode(const Packet& packet) = 0;

 protected:
  ImageDecoder() = default;
  ImageDecoder(const ImageDecoder&) = default;
  ImageDecoder& operator=(const ImageDecoder&) = default;
};

/// Bytes of a thermal camera → pictures. Pure: no device, no clock, no file.
class ThermalDecoder {
 public:
  virtual ~ThermalDecoder() = default;
  /// As ImageDecoder::decode(). Null means that the device repeated its last frame.
  virtual Result<const ThermalImage*> decode(const Packet& packet) = 0;

 protected:
  ThermalDecoder() = default;
  ThermalDecoder(const ThermalDecoder&) = default;
  ThermalDecoder& operator=(const ThermalDecoder&) = default;
};

/// A picture → the class of each pixel. May take a tenth of a second. Bounded memory.
class Segmenter {
 public:
  virtual ~Segmenter() = default;
  /// `picture` is kBgr8 or kMono8. The labels are the segmenter's and stay valid until the next call. An Error means
  /// that this picture gets no labels.
  virtual Result<const LabelImage*> segment(const Image& picture) = 0;

 protected:
  Segmenter() = default;
  Segmenter(const Segmenter&) = default;
  Segmenter& operator=(const Segmenter&) = default;
};

/// A picture → boxes around things.
class Detector {
 public:
  virtual ~Detector() = default;
  /// As Segmenter::segment().
  virtual Result<const Detections*> detect(const Image& picture) = 0;

 protected:
  Detector() = default;
  Detector(const Detector&) = default;
  Detector& operator=(const Detector&) = default;
};

}  // namespace cairn
