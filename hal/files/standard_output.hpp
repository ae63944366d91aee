// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string_view>

#include "hal/result.hpp"

namespace cairn {

/// Hands everything that was printed on `out` to the system. Error kIo: a part of it was not taken, now or before.
[[nodiscard]] Result<void> flush_output(std::FILE* out);

/// For the end of main(): flushes stdout. Where that fails, `program` says so on stderr, and the exit code is not 0 but
/// 1. Otherwise it is `code`.
[[nodiscard]] int end_of_program(std::string_view program, int code);

}  // namespace cairn
