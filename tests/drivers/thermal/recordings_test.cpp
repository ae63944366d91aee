// SPDX-License-Identifier: Apache-2.0
// Real frames: an animal walks past a Lepton 3, and one picture of a 640×512 camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "drivers/camera/npy.hpp"
#include "drivers/camera/picture_file.hpp"
#include "drivers/thermal/thermal.hpp"
#include "hal/files/file.hpp"
#include "tests/drivers/recording/files.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::thermal {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// CAIRN_PICTURES names a folder: then the stretched frames are left there as .pgm, for looking.
void keep_picture(const Image& image, const std::string& name) {
  const char* folder = std::getenv("CAIRN_PICTURES");
  if (folder == nullptr) return;
  std::ofstream out(fs::path(folder) / (name + ".pgm"), std::ios::binary);
  out << "P5 " << image.width << " " << image.height << " 255\n";
  out.write(reinterpret_cast<const char*>(image.bytes.data()), static_cast<std::streamsize>(image.bytes.size()));
}

struct Frame {
  std::vector<int> counts;
  std::vector<std::byte> stretched;
};

std::vector<Frame> decode_all(const fs::path& path) {
  Config config;
  config.units = "auto";
  Thermal decoder = Thermal::create(config).value();
  const auto source = camera::NpySource::open(path, {}).value();
  std::vector<Frame> frames;
  Packet packet;
  while (source->next(packet, 0s).value() == Poll::kPacket) {
    const auto image = decoder.decode(packet);
    EXPECT_TRUE(image);
    EXPECT_FALSE((*image)->radiometric()) << "nothing says what these counts are";
    Frame& frame = frames.emplace_back();
    const ImageView view = (*image)->values.view();
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) frame.counts.push_back(view.at<std::uint16_t>(x, y));
    frame.stretched = (*image)->stretched.bytes;
    if (frames.size() % 10 == 1) keep_picture((*image)->stretched, "lepton" + std::to_string(frames.size() - 1));
  }
  return frames;
}

std::vector<int> median_picture(const std::vector<Frame>& frames) {
  std::vector<int> median(frames[0].counts.size()), values(frames.size());
  for (std::size_t i = 0; i < median.size(); ++i) {
    for (std::size_t f = 0; f < frames.size(); ++f) values[f] = frames[f].counts[i];
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    median[i] = values[values.size() / 2];
  }
  return median;
}

/// The connected pixels that are `above` counts warmer than the picture without the animal.
struct Blob {
  std::size_t pixels = 0;
  double x = 0;     ///< centre
  int warmest = 0;  ///< counts
};

Blob grow(std::vector<bool>& warm, const std::vector<int>& counts, std::size_t seed) {
  constexpr std::size_t kWidth = 160, kHeight = 120;
  Blob blob;
  std::vector<std::size_t> open{seed};
  warm[seed] = false;
  while (!open.empty()) {
    const std::size_t i = open.back(), x = i % kWidth, y = i / kWidth;
    open.pop_back();
    ++blob.pixels;
    blob.x += static_cast<double>(x);
    blob.warmest = std::max(blob.warmest, counts[i]);
    const auto visit = [&](bool inside, std::size_t j) {
      if (!inside || !warm[j]) return;
      warm[j] = false;
      open.push_back(j);
    };
    visit(x > 0, i - 1);
    visit(x + 1 < kWidth, i + 1);
    visit(y > 0, i - kWidth);
    visit(y + 1 < kHeight, i + kWidth);
  }
  blob.x /= static_cast<double>(blob.pixels);
  return blob;
}

std::vector<Blob> moving_blobs(const std::vector<int>& counts, const std::vector<int>& background) {
  constexpr int kAbove = 60;
  std::vector<bool> warm(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) warm[i] = counts[i] > background[i] + kAbove;
  std::vector<Blob> blobs;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (warm[i]) blobs.push_back(grow(warm, counts, i));
  return blobs;
}

TEST(LeptonRecording, TheAnimalIsTheWarmestMovingBlobAndWalksToTheLeft) {
  const auto path = support::recorded_data("thermal/lepton3_possum_161x120x160_u16.npy");
  if (!fs::exists(path)) GTEST_SKIP() << recording::test::missing(path);
  const auto frames = decode_all(path);
  ASSERT_EQ(frames.size(), 161U);
  const auto background = median_picture(frames);
  std::vector<double> centres;
  for (std::size_t f = 44; f <= 60; f += 2) {
    const auto& counts = frames[f].counts;
    const auto blobs = moving_blobs(counts, background);
    ASSERT_FALSE(blobs.empty()) << f;
    const Blob animal =
        *std::max_element(blobs.begin(), blobs.end(), [](const Blob& a, const Blob& b) { return a.pixels < b.pixels; });
    EXPECT_GT(animal.pixels, 60U) << f;
    EXPECT_EQ(animal.warmest, *std::max_element(counts.begin(), counts.end()))
        << f << ": warmer than anything in the picture";
    const auto warmest = std::max_element(counts.begin(), counts.end()) - counts.begin();
    EXPECT_EQ(frames[f].stretched[static_cast<std::size_t>(warmest)], std::byte{255}) << f;
    centres.push_back(animal.x);
  }
  EXPECT_TRUE(std::is_sorted(centres.rbegin(), centres.rend()));
  EXPECT_GT(centres.front() - centres.back(), 25);
}

TEST(TiffRecording, ARealFrameIsCountsUntilItsUnitIsTold) {
  const auto path = support::recorded_data("thermal/example_radiometric.tiff");
  if (!fs::exists(path)) GTEST_SKIP() << recording::test::missing(path);
  Packet packet;
  ASSERT_TRUE(camera::picture_to_packet(read_file(path, 1 << 20).value(), camera::FrameFormat::kY16, packet.bytes));
  Config config;
  config.model = "boson640";
  Thermal decoder = Thermal::create(config).value();
  const auto image = decoder.decode(packet);
  ASSERT_TRUE(image) << to_string(image.error());
  EXPECT_FALSE((*image)->radiometric());
  EXPECT_EQ((*image)->values.width, 640);
  keep_picture((*image)->stretched, "tiff");
}

}  // namespace
}  // namespace cairn::thermal
