// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/command.hpp"

#include <iostream>

#include "onboard/app/report/report_json.hpp"

namespace cairn::cli {

int fail(const Error& error) {
  std::cerr << "cairn: " << to_string(error) << '\n';
  return error.code == Errc::kInvalidConfig ? kWrongArguments : kFailed;
}

int print(const Json& object) {
  std::cout << to_text(object);
  return kDone;
}

}  // namespace cairn::cli
