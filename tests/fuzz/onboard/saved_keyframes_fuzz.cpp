// SPDX-License-Identifier: Apache-2.0
// Any bytes in place of saved keyframes, once as they are and once with the checksum that makes them be read: an error,
// or finite poses and landmarks that survive being written.
#include <span>
#include <vector>

#include "onboard/app/restart/saved_bytes.hpp"
#include "onboard/app/restart/saved_keyframes.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto bytes = std::as_bytes(std::span(data, size));
  (void)app::decode_keyframes(bytes);
  std::vector<std::byte> sealed(bytes.begin(), bytes.end());
  app::seal(sealed);
  const auto saved = app::decode_keyframes(sealed);
  if (!saved) return 0;
  require(saved->keyframes.size() <= visual_odometry::PlaceMemory::kPlaces);
  for (const visual_odometry::Keyframe& keyframe : saved->keyframes) {
    require(keyframe.T_odom_base.matrix().allFinite());
    require(keyframe.descriptors.size() == keyframe.landmarks.size());
    for (const auto& landmark : keyframe.landmarks)
      require(landmark.p_odom.allFinite() && landmark.covariance.allFinite());
  }
  const auto again = app::decode_keyframes(app::encode(*saved));
  require(again.has_value() && again->epoch == saved->epoch && again->keyframes.size() == saved->keyframes.size());
  return 0;
}
