// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "drivers/clients/messages/command.hpp"

namespace cairn::clients {

/// Where answers to commands go; live only.
class AnswerPort {
 public:
  virtual ~AnswerPort() = default;
  /// Never waits. False: the client is gone, or does not read.
  virtual bool answer(std::uint16_t client, const Answer& answer) = 0;

 protected:
  AnswerPort() = default;
  AnswerPort(const AnswerPort&) = default;
  AnswerPort& operator=(const AnswerPort&) = default;
};

}  // namespace cairn::clients
