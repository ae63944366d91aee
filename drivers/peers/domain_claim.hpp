// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "hal/result.hpp"

namespace cairn::peer_link {

/// A DDS domain that no other program of this machine has claimed: teams that run on one machine at the same time do
/// not hear each other. Given back at its end, and when the program dies.
class DomainClaim {
 public:
  /// Errors: kLimit (all are taken), kIo.
  static Result<DomainClaim> make();
  DomainClaim(DomainClaim&& other) noexcept : domain_(other.domain_), socket_(std::exchange(other.socket_, -1)) {}
  DomainClaim& operator=(DomainClaim&&) = delete;
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;
  ~DomainClaim();

  [[nodiscard]] unsigned domain() const { return domain_; }

 private:
  DomainClaim(unsigned domain, int socket) : domain_(domain), socket_(socket) {}
  unsigned domain_;
  int socket_;
};

}  // namespace cairn::peer_link
