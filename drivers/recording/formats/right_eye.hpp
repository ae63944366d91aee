// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::recording {

/// The id of the source that a stereo camera's right eye has where the eyes are not side by side in one picture. The
/// left eye is then the source `camera`.
inline constexpr const char* kRightEye = "camera_right";

}  // namespace cairn::recording
