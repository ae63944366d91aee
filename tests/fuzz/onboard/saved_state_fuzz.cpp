// SPDX-License-Identifier: Apache-2.0
// Any text in place of a saved state: an error, or a state of finite numbers that survives being written.
#include <string_view>

#include "onboard/app/restart/saved_state.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto state = app::parse_state({reinterpret_cast<const char*>(data), size});
  if (!state) return 0;
  require(state->T_odom_base.mean.matrix().allFinite() && state->twist.allFinite());
  require(state->T_odom_base.covariance.allFinite() && state->boot.size() <= 64);
  const auto again = app::parse_state(app::to_text(*state));
  require(again.has_value() && again->stamp == state->stamp && again->twist == state->twist);
  return 0;
}
