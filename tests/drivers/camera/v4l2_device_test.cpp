// SPDX-License-Identifier: Apache-2.0
// Against a real kernel: CAIRN_TEST_VIDEO names the device (in the virtual machine vivid or an emulated UVC camera).
// CAIRN_TEST_VIDEO_UNPLUG and CAIRN_TEST_VIDEO_REPLUG are shell commands, CAIRN_TEST_VIDEO_CYCLES says how often; with
// CAIRN_TEST_VIDEO_RAMP=1 the 16-bit pixels of a row rise by three from column to column. CAIRN_TEST_VIDEO_EARLY=1: the
// device stamps a frame with its end when it has just begun, as vivid does; the source then takes its own clock and
// counts.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "drivers/camera/camera.hpp"
#include "drivers/camera/v4l2_source.hpp"

namespace cairn::camera {
namespace {

using namespace std::chrono_literals;

std::string setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::size_t entries_of(const char* folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

class V4l2DeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    path = setting("CAIRN_TEST_VIDEO");
    if (path.empty()) GTEST_SKIP() << "CAIRN_TEST_VIDEO names no capture device";
  }
  std::vector<OfferedMode> decodable_modes() {
    std::vector<OfferedMode> modes;
    for (const OfferedMode& m : offered_modes(kernel_calls(), path))
      if (find_format(m.format) != nullptr && (modes.empty() || modes.back().format != m.format)) modes.push_back(m);
    return modes;
  }
  CaptureConfig config_of(const OfferedMode& mode) const {
    CaptureConfig config;
    config.device = path;
    config.format = find_format(mode.format)->name;
    config.width = static_cast<int>(mode.width);
    config.height = static_cast<int>(mode.height);
    return config;
  }
  /// Polls until a frame comes; virtual machines may take their time.
  static bool wait_for_frame(V4l2Source& source, Packet& packet, Duration limit) {
    const LiveClock now;
    for (const Time end = now.now() + limit; now.now() < end;) {
      const auto got = source.next(packet, 200ms);
      if (got && *got == Poll::kPacket) return true;
    }
    return false;
  }

  std::string path;
  LiveClock clock;
};

void expect_ramp(const ImageView& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      ASSERT_EQ(image.at<std::uint16_t>(x, y), static_cast<std::uint16_t>(image.at<std::uint16_t>(0, 0) + 3 * x));
}

TEST_F(V4l2DeviceTest, EveryFormatWeDecodeStreams) {
  const auto modes = decodable_modes();
  ASSERT_FALSE(modes.empty()) << "offered: " << to_string(offered_modes(kernel_calls(), path));
  for (const OfferedMode& mode : modes) {
    SCOPED_TRACE(to_string(std::span(&mode, 1)));
    auto source = V4l2Source::open(config_of(mode), SourceId{}, clock);
    ASSERT_TRUE(source) << to_string(source.error());
    Camera camera = Camera::create({}).value();
    Packet packet;
    Time last = Time::min();
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE(wait_for_frame(**source, packet, 20s)) << i;
      EXPECT_GT(packet.arrival, last);
      EXPECT_LE(packet.arrival, clock.now());
      last = packet.arrival;
      const auto image = camera.decode(packet);
      ASSERT_TRUE(image) << to_string(image.error());
      EXPECT_EQ((*image)->width, static_cast<int>(mode.width));
      EXPECT_EQ((*image)->height, static_cast<int>(mode.height));
      const bool deep = bytes_per_pixel((*image)->format) == 2;
      if (deep && !setting("CAIRN_TEST_VIDEO_RAMP").empty()) expect_ramp((*image)->view());
    }
    // The clock of a virtual machine jumps when it was held up: then the stamp of a frame may lie in the future.
    if (setting("CAIRN_TEST_VIDEO_EARLY").empty())
      EXPECT_LT((*source)->counters().unstamped, 5U);
    else
      EXPECT_EQ((*source)->counters().unstamped, 5U);
  }
}

TEST_F(V4l2DeviceTest, FormatsThatItHasNotAreRefusedWithWhatItHas) {
  auto modes = decodable_modes();
  ASSERT_FALSE(modes.empty());
  modes[0].width = 2;
  modes[0].height = 2;
  const auto source = V4l2Source::open(config_of(modes[0]), SourceId{}, clock);
  if (source) GTEST_SKIP() << "the device takes 2x2";
  EXPECT_NE(source.error().detail.find("it offers"), std::string::npos) << to_string(source.error());
}

TEST_F(V4l2DeviceTest, UnplugAndReplugLeaveNothingBehind) {
  const std::string unplug = setting("CAIRN_TEST_VIDEO_UNPLUG"), replug = setting("CAIRN_TEST_VIDEO_REPLUG");
  if (unplug.empty() || replug.empty()) GTEST_SKIP() << "CAIRN_TEST_VIDEO_UNPLUG and _REPLUG name no commands";
  const auto modes = decodable_modes();
  ASSERT_FALSE(modes.empty());
  auto source = V4l2Source::open(config_of(modes[0]), SourceId{}, clock).value();
  Packet packet;
  ASSERT_TRUE(wait_for_frame(*source, packet, 20s));
  const std::size_t files = entries_of("/proc/self/fd"), maps = entries_of("/proc/self/map_files");
  const std::string cycles = setting("CAIRN_TEST_VIDEO_CYCLES");
  for (int i = cycles.empty() ? 1 : std::atoi(cycles.c_str()); i > 0; --i) {
    ASSERT_EQ(std::system(unplug.c_str()), 0);
    for (int polls = 0; source->connected() && polls < 100; ++polls) (void)source->next(packet, 200ms);
    ASSERT_FALSE(source->connected());
    ASSERT_EQ(std::system(replug.c_str()), 0);
    ASSERT_TRUE(wait_for_frame(*source, packet, 20s)) << i << " cycles before the end";
  }
  EXPECT_EQ(entries_of("/proc/self/fd"), files);
  EXPECT_LE(entries_of("/proc/self/map_files"), maps + 8);  // the allocator may have grown
}

}  // namespace
}  // namespace cairn::camera
