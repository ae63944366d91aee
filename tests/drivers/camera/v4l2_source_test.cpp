// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/v4l2_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <random>

#include "tests/drivers/camera/fake_v4l2.hpp"

namespace cairn::camera {
namespace {

using namespace std::chrono_literals;
using test::FakeV4l2;
using testing::ElementsAre;
using testing::HasSubstr;

class V4l2SourceTest : public testing::Test {
 protected:
  V4l2SourceTest() {
    clock.advance_to(Time{1000s});
    config.device = "/dev/v4l/by-id/fake";
    config.width = 4;
    config.height = 2;
  }
  Result<std::unique_ptr<V4l2Source>> try_open() { return V4l2Source::open(config, SourceId{2}, clock, device); }
  void open() { source = try_open().value(); }
  Result<Poll> next(Duration timeout = 1s) { return source->next(packet, timeout); }
  std::string refusal() {
    const auto opened = try_open();
    EXPECT_EQ(device.open_fds, 0);
    EXPECT_EQ(device.mapped, 0);
    return opened ? "" : to_string(opened.error());
  }
  void send(std::uint32_t sequence, Duration in = 10ms) {
    device.send({clock.now() + in, device.good_frame(), sequence});
  }

  VirtualClock clock;
  FakeV4l2 device{clock};
  CaptureConfig config;
  std::unique_ptr<V4l2Source> source;
  Packet packet;
};

TEST_F(V4l2SourceTest, NegotiatesReadsBackAndStreams) {
  device.stride = 12;
  device.period = {1, 30};
  open();
  EXPECT_THAT(device.log,
              ElementsAre("QUERYCAP", "S_FMT", "G_FMT", "G_PARM", "S_PARM", "G_PARM", "REQBUFS", "STREAMON"));
  EXPECT_EQ(source->granted().rate_hz, 30);
  EXPECT_EQ(source->granted().buffers, 4U);
  send(0);
  ASSERT_EQ(next().value(), Poll::kPacket);
  const auto frame = parse_frame(packet.payload());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.bytes_per_line, 12U);
  EXPECT_EQ(frame->payload.size(), 24U);
  EXPECT_TRUE(frame->header.start_of_exposure);
  EXPECT_EQ(packet.source, SourceId{2});
  EXPECT_EQ(packet.arrival, Time{1000s + 10ms});
}

TEST_F(V4l2SourceTest, TheEndOfTheFrameIsNotTheStartOfTheExposure) {
  open();
  device.send({clock.now() + 5ms, device.good_frame(), 0, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC});
  ASSERT_EQ(next().value(), Poll::kPacket);
  EXPECT_FALSE(parse_frame(packet.payload())->header.start_of_exposure);
  EXPECT_EQ(source->counters().unstamped, 0U);
}

TEST_F(V4l2SourceTest, StampsOfAnotherClockAreReplaced) {
  open();
  device.send({clock.now() + 5ms, device.good_frame(), 0, V4L2_BUF_FLAG_TIMESTAMP_COPY});
  device.send({Time{3s}, device.good_frame(), 1, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC});
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(next().value(), Poll::kPacket);
    EXPECT_EQ(packet.arrival, clock.now());
  }
  EXPECT_EQ(source->counters().unstamped, 2U);
}

TEST_F(V4l2SourceTest, RefusesNodesThatDoNotCapture) {
  device.device_caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(refusal(), HasSubstr("-video-index0"));
  device.device_caps = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_THAT(refusal(), HasSubstr("cannot stream"));
  device.capabilities = 0;  // an old driver: `capabilities` is all there is
  EXPECT_TRUE(try_open());
}

TEST_F(V4l2SourceTest, SaysWhatIsOfferedWhenTheWishIsNot) {
  config.width = 6;
  EXPECT_THAT(refusal(), HasSubstr("it offers YUYV 4x2"));
  config.width = 4;
  device.format = V4L2_PIX_FMT_UYVY;
  EXPECT_THAT(refusal(), HasSubstr("would get UYVY 4x2"));
}

TEST_F(V4l2SourceTest, RefusesWhatItCannotUse) {
  device.field = V4L2_FIELD_INTERLACED;
  EXPECT_THAT(refusal(), HasSubstr("interlaced"));
  device.field = V4L2_FIELD_NONE;
  device.stride = 7;
  EXPECT_THAT(refusal(), HasSubstr("shorter than their pixels"));
  device.stride = 8;
  device.max_buffers = 1;
  EXPECT_THAT(refusal(), HasSubstr("less than two buffers"));
  device.plugged = false;
  EXPECT_THAT(refusal(), HasSubstr("/dev/v4l/by-id"));
}

TEST_F(V4l2SourceTest, EveryFailedCallOfTheOpeningGivesEverythingBack) {
  for (const unsigned long request :
       {VIDIOC_QUERYCAP, VIDIOC_S_FMT, VIDIOC_G_FMT, VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF, VIDIOC_STREAMON}) {
    device.fail = {{request, EBUSY}};
    EXPECT_THAT(refusal(), HasSubstr("another program"));
  }
  for (const unsigned long request : {VIDIOC_G_PARM, VIDIOC_S_PARM}) {
    device.fail = {{request, ENOTTY}};  // a camera without a rate to set is fine
    EXPECT_TRUE(try_open());
  }
}

TEST_F(V4l2SourceTest, CountsGapsOverTheWrapOfTheDriversCounter) {
  open();
  for (const std::uint32_t s : {0xFFFFFFF0U, 0xFFFFFFF1U, 0xFFFFFFF5U, 2U}) send(s);
  std::vector<std::uint64_t> steps;
  for (int i = 0; i < 4; ++i) {
    const std::uint64_t before = packet.sequence;
    ASSERT_EQ(next().value(), Poll::kPacket);
    steps.push_back(packet.sequence - before);
  }
  EXPECT_THAT(steps, ElementsAre(1, 1, 4, 13));
  EXPECT_EQ(source->counters().lost, 3U + 12U);
  EXPECT_EQ(source->counters().delivered, 4U);
}

TEST_F(V4l2SourceTest, DropsAndCountsBadFrames) {
  open();
  device.send({clock.now(), device.good_frame(), 0, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_ERROR});
  device.send({clock.now(), std::vector<std::byte>(15), 1});
  device.send({clock.now(), {}, 2});
  send(3);
  ASSERT_EQ(next().value(), Poll::kPacket);
  EXPECT_EQ(source->counters().corrupt, 1U);
  EXPECT_EQ(source->counters().cut_off, 2U);
  EXPECT_EQ(source->counters().lost, 0U);
}

TEST_F(V4l2SourceTest, BytesUsedBeyondTheBufferAreNotRead) {
  open();
  device.send({clock.now(), std::vector<std::byte>(1'000'000), 0});
  ASSERT_EQ(next().value(), Poll::kPacket);
  EXPECT_EQ(packet.bytes.size(), kFrameHeaderBytes + 16 + 16);
}

TEST_F(V4l2SourceTest, WaitsAsLongAsToldAndNoLonger) {
  open();
  EXPECT_EQ(next(300ms).value(), Poll::kTimeout);
  EXPECT_EQ(clock.now(), Time{1000s + 300ms});
  EXPECT_EQ(next(0ms).value(), Poll::kTimeout);
  EXPECT_EQ(clock.now(), Time{1000s + 300ms});
}

TEST_F(V4l2SourceTest, AFloodOfBadFramesDoesNotHoldTheCaller) {
  open();
  for (std::uint32_t i = 0; i < 1000; ++i) device.send({clock.now(), {}, i});
  EXPECT_EQ(next().value(), Poll::kTimeout);
  EXPECT_EQ(source->counters().cut_off, static_cast<std::uint64_t>(V4l2Source::kMaxLooked));
}

TEST_F(V4l2SourceTest, AnInputOutputErrorStartsTheStreamFromNothing) {
  open();
  send(0);
  ASSERT_EQ(next().value(), Poll::kPacket);
  device.fail = {{VIDIOC_DQBUF, EIO}};
  const auto broken = next();
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().code, Errc::kIo);
  device.fail.clear();
  device.log.clear();
  send(0);
  ASSERT_EQ(next().value(), Poll::kPacket);
  EXPECT_THAT(device.log, ElementsAre("STREAMOFF", "REQBUFS", "S_FMT", "G_FMT", "G_PARM", "S_PARM", "G_PARM", "REQBUFS",
                                      "STREAMON"));
  EXPECT_EQ(device.opened, 1);
  EXPECT_EQ(source->counters().restarts, 1U);
  EXPECT_EQ(source->counters().lost, 0U);
}

TEST_F(V4l2SourceTest, SilenceIsTreatedAsABrokenStream) {
  open();
  EXPECT_EQ(next(5s).value_or(Poll::kTimeout), Poll::kTimeout);
  EXPECT_EQ(source->counters().restarts, 3U);
  EXPECT_EQ(source->counters().closed, 1U);  // 4 × 700 ms of nothing
  EXPECT_FALSE(source->connected());
}

TEST_F(V4l2SourceTest, UnpluggedItClosesEverythingAndComesBack) {
  open();
  device.plugged = false;
  const auto gone = next();
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Errc::kLinkDown);
  EXPECT_EQ(device.open_fds, 0);
  EXPECT_EQ(device.mapped, 0);
  const Time lost = clock.now();
  EXPECT_EQ(next(1s).value(), Poll::kTimeout);  // at 0.1, 0.3, 0.7 s
  EXPECT_EQ(device.opened, 1 + 3);
  EXPECT_EQ(clock.now(), lost + 1s);
  device.plugged = true;
  device.frame_period = 66ms;
  ASSERT_EQ(next(2s).value(), Poll::kPacket);
  EXPECT_LE(clock.now(), lost + 3s);
  EXPECT_EQ(source->counters().reopened, 1U);
}

TEST_F(V4l2SourceTest, AThousandReplugsLeaveNothingOpenAndFramesBackInThreeSeconds) {
  device.frame_period = 66ms;
  open();
  std::uint64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(next().value(), Poll::kPacket);
    ASSERT_GT(packet.sequence, last);
    last = packet.sequence;
    device.plugged = false;
    while (source->connected()) (void)next();
    ASSERT_EQ(device.open_fds + device.mapped, 0);
    (void)next(Duration{i * 7ms});
    device.plugged = true;
    const Time plugged = clock.now();
    while (next(100ms).value() != Poll::kPacket) ASSERT_LE(clock.now(), plugged + 3s);
  }
  EXPECT_EQ(device.open_fds, 1);
  EXPECT_EQ(device.mapped, 4);
}

TEST_F(V4l2SourceTest, AnAlarmWithoutACauseIsNotSpunOn) {
  open();
  device.poll_alarm = POLLERR;
  int errors = 0;
  for (int i = 0; i < 20 && source->connected(); ++i) errors += next() ? 0 : 1;
  EXPECT_FALSE(source->connected());
  EXPECT_EQ(errors, 5);  // broken four times, given up once
}

/// Whatever fails and however often: nothing leaks, time-outs are kept, and frames come when it is over.
TEST_F(V4l2SourceTest, SurvivesAnyFailure) {
  device.frame_period = 66ms;
  open();
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    device.fault = [&](unsigned long) {
      constexpr std::array kWhy{EIO, ENODEV, EBUSY, EINVAL, ENOMEM, EAGAIN};
      return random() % 4 == 0 ? kWhy[random() % kWhy.size()] : 0;
    };
    for (int i = 0; i < 30; ++i) {
      if (random() % 10 == 0) device.plugged = !device.plugged;
      const Time before = clock.now();
      (void)next(50ms);
      ASSERT_LE(clock.now(), before + 50ms);
      ASSERT_EQ(device.open_fds, source->connected() ? 1 : 0);
      ASSERT_EQ(device.mapped, source->connected() ? 4 : 0);
    }
    device.fault = {};
    device.plugged = true;
    const Time well = clock.now();
    for (;;) {
      const auto got = next(100ms);
      if (got && *got == Poll::kPacket) break;
      ASSERT_LE(clock.now(), well + 3s);
    }
  }
}

}  // namespace
}  // namespace cairn::camera
