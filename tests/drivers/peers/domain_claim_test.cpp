// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/domain_claim.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace cairn::peer_link {
namespace {

TEST(DomainClaim, TwoAtATimeAreDifferent) {
  const auto one = DomainClaim::make(), two = DomainClaim::make();
  ASSERT_TRUE(one && two);
  EXPECT_NE(one->domain(), two->domain());
}

/// Tests that run beside this one may take what it gives back, but not all that there are.
TEST(DomainClaim, IsGivenBack) {
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(DomainClaim::make()) << i;
}

TEST(DomainClaim, MovesWithItsDomain) {
  auto first = DomainClaim::make();
  ASSERT_TRUE(first);
  const unsigned domain = first->domain();
  std::optional<DomainClaim> second(*std::move(first));
  EXPECT_EQ(second->domain(), domain);
  const auto third = DomainClaim::make();
  ASSERT_TRUE(third);
  EXPECT_NE(third->domain(), domain) << "still held";
}

}  // namespace
}  // namespace cairn::peer_link
