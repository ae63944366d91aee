// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/sdo_client.hpp"

#include <gtest/gtest.h>

namespace cairn::drive::canopen {
namespace {

using namespace std::chrono_literals;
constexpr Object kThing{0x6041, 0};

class SdoClientTest : public testing::Test {
 protected:
  std::size_t step(Duration at) {
    out.clear();
    client.step(Time{at}, out);
    return out.frames().size();
  }
  SdoClient client{3};
  TxQueue out;
};

TEST_F(SdoClientTest, Reads) {
  client.read(kThing);
  ASSERT_EQ(step(0ms), 1U);
  EXPECT_EQ(out.frames()[0], sdo_read(3, kThing));
  EXPECT_EQ(step(100ms), 0U);
  client.receive(sdo_response(3, {SdoResponse::Kind::kValue, kThing, 0x637, 2}));
  EXPECT_EQ(client.state(), SdoClient::State::kDone);
  EXPECT_EQ(client.response().value, 0x637U);
}

TEST_F(SdoClientTest, RepeatsOnceThenAborts) {
  client.write(kThing, 1, 2);
  EXPECT_EQ(step(0ms), 1U);
  EXPECT_EQ(step(249ms), 0U);
  EXPECT_EQ(step(250ms), 1U);
  EXPECT_EQ(out.frames()[0], sdo_write(3, kThing, 1, 2));
  EXPECT_EQ(step(500ms), 1U);
  EXPECT_EQ(out.frames()[0], sdo_abort(3, kThing, kAbortTimeout));
  EXPECT_EQ(client.state(), SdoClient::State::kTimedOut);
  client.receive(sdo_response(3, {SdoResponse::Kind::kWritten, kThing, 0, 0}));
  EXPECT_EQ(client.state(), SdoClient::State::kTimedOut) << "too late";
}

TEST_F(SdoClientTest, TakesOnlyItsOwnAnswer) {
  client.read(kThing);
  client.receive(sdo_response(3, {SdoResponse::Kind::kValue, kThing, 1, 2}));
  EXPECT_EQ(client.state(), SdoClient::State::kBusy) << "an answer before the question";
  step(0ms);
  client.receive(sdo_response(4, {SdoResponse::Kind::kValue, kThing, 1, 2}));
  client.receive(sdo_response(3, {SdoResponse::Kind::kValue, {0x6040, 0}, 1, 2}));
  client.receive(sdo_response(3, {SdoResponse::Kind::kWritten, kThing, 0, 0}));
  EXPECT_EQ(client.state(), SdoClient::State::kBusy);
  client.receive(sdo_response(3, {SdoResponse::Kind::kAbort, kThing, kAbortNoObject, 0}));
  EXPECT_EQ(client.state(), SdoClient::State::kAborted);
  EXPECT_EQ(abort_text(client.response().value), "object does not exist");
}

TEST_F(SdoClientTest, ASegmentedAnswerEndsTheTransfer) {
  client.read(kThing);
  step(0ms);
  client.receive(make_frame(0x583, {0x41, 0x41, 0x60, 0, 20, 0, 0, 0}));
  EXPECT_EQ(client.state(), SdoClient::State::kAborted);
}

TEST(TxQueue, TheNewestOfItsKindReplaces) {
  TxQueue queue;
  queue.push(make_frame(0x201, {1}));
  queue.push(make_frame(0x202, {1}));
  queue.push(make_frame(0x201, {2}));
  ASSERT_EQ(queue.frames().size(), 2U);
  EXPECT_EQ(queue.frames()[0].data[0], 2);
  queue.push(nmt(NmtCommand::kStart, 1));
  queue.push(nmt(NmtCommand::kStart, 2));
  queue.push(nmt(NmtCommand::kStop, 2));
  EXPECT_EQ(queue.frames().size(), 4U) << "NMT commands to different nodes stay";
  queue.drop_front(3);
  EXPECT_EQ(queue.frames()[0], nmt(NmtCommand::kStop, 2));
  for (std::uint32_t id = 0x300; id < 0x400; ++id) queue.push(make_frame(id, {}));
  EXPECT_EQ(queue.frames().size(), TxQueue::kCapacity);
  EXPECT_GT(queue.dropped(), 0U);
}

TEST(Every, KeepsItsPhaseAndSkipsMissedReleases) {
  Every every{10ms};
  EXPECT_TRUE(every.due(Time{3ms}));
  EXPECT_FALSE(every.due(Time{12ms}));
  EXPECT_TRUE(every.due(Time{14ms}));
  EXPECT_TRUE(every.due(Time{57ms}));
  EXPECT_FALSE(every.due(Time{62ms}));
  EXPECT_TRUE(every.due(Time{63ms}));
}

}  // namespace
}  // namespace cairn::drive::canopen
