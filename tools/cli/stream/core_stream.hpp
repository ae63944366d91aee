// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "onboard/client/robot_stream.hpp"

namespace cairn::cli {

/// Hands each message of a core to `take`, until that says false or Ctrl-C comes; then Ok. `idle` is asked ten times a
/// second, likewise. Errors: no core is there; the core is gone; its records are of another release.
Result<void> read_core(const std::filesystem::path& socket, const client::SubscribeMessage& wants,
                       const std::function<Result<bool>(client::StreamMessage&)>& take,
                       const std::function<Result<bool>()>& idle, std::uint64_t* lost = nullptr);

}  // namespace cairn::cli
