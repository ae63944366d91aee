// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/local_link.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace cairn::peer_link {
namespace {

const std::vector<std::byte> kBytes(100, std::byte{5});

std::size_t received(LocalLink& link) {
  std::vector<std::byte> memory;
  LinkFrame frame;
  std::size_t count = 0;
  while (link.receive(memory, frame)) {
    EXPECT_EQ(frame.robot, 9U);
    EXPECT_TRUE(std::equal(kBytes.begin(), kBytes.end(), frame.bytes.begin(), frame.bytes.end()));
    ++count;
  }
  return count;
}

TEST(LocalLink, CarriesFramesBothWays) {
  const support::TemporaryFolder folder;
  auto core = LocalLink::listen(folder.path() / "peers.sock").value();
  LocalLink peer = LocalLink::connect(folder.path() / "peers.sock");
  EXPECT_FALSE(core.join());
  EXPECT_TRUE(peer.join());
  EXPECT_TRUE(core.join());
  EXPECT_TRUE(peer.send({LinkFrame::Kind::kReceived, 9, kBytes}));
  EXPECT_TRUE(core.send({LinkFrame::Kind::kSend, 9, kBytes}));
  EXPECT_EQ(received(core), 1U);
  EXPECT_EQ(received(peer), 1U);
}

TEST(LocalLink, NobodyThereIsNoError) {
  const support::TemporaryFolder folder;
  LocalLink peer = LocalLink::connect(folder.path() / "peers.sock");
  EXPECT_FALSE(peer.join());
  EXPECT_FALSE(peer.send({LinkFrame::Kind::kSend, 9, kBytes}));
  EXPECT_EQ(peer.counters().lost, 1U);
  EXPECT_EQ(received(peer), 0U);
}

TEST(LocalLink, ADeafReaderCostsFramesAndNothingElse) {
  const support::TemporaryFolder folder;
  auto core = LocalLink::listen(folder.path() / "peers.sock").value();
  LocalLink peer = LocalLink::connect(folder.path() / "peers.sock");
  ASSERT_TRUE(peer.join() && core.join());
  for (int i = 0; i < 100'000; ++i) core.send({LinkFrame::Kind::kSend, 9, kBytes});
  EXPECT_GT(core.counters().lost, 0U);
  EXPECT_EQ(received(peer), core.counters().sent);
}

TEST(LocalLink, EitherEndMayComeBack) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "peers.sock";
  auto core = std::optional(LocalLink::listen(path).value());
  auto peer = std::optional(LocalLink::connect(path));
  ASSERT_TRUE(peer->join() && core->join());
  peer.emplace(LocalLink::connect(path));  // the peer process died and began anew
  ASSERT_TRUE(peer->join() && core->join());
  EXPECT_TRUE(peer->send({LinkFrame::Kind::kReceived, 9, kBytes}));
  EXPECT_EQ(received(*core), 1U);
  core.reset();
  EXPECT_EQ(received(*peer), 0U);  // notices
  EXPECT_FALSE(peer->join());
  core.emplace(LocalLink::listen(path).value());
  ASSERT_TRUE(peer->join() && core->join());
  EXPECT_TRUE(core->send({LinkFrame::Kind::kSend, 9, kBytes}));
  EXPECT_EQ(received(*peer), 1U);
}

TEST(LocalLink, SaysWhyItCannotListen) {
  const support::TemporaryFolder folder;
  EXPECT_EQ(LocalLink::listen(folder.path() / std::string(200, 'x')).error().code, Errc::kInvalidConfig);
  EXPECT_EQ(LocalLink::listen(folder.path() / "no" / "folder").error().code, Errc::kIo);
  const auto core = LocalLink::listen(folder.path() / "peers.sock").value();
  EXPECT_EQ(LocalLink::listen(folder.path() / "peers.sock").error().cause, "another core serves this socket");
}

}  // namespace
}  // namespace cairn::peer_link
