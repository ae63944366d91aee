// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/image_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/camera/convert.hpp"
#include "tests/drivers/camera/frames.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using namespace std::chrono_literals;
using camera::FrameFormat;
using camera::test::header_of;
using camera::test::packet_of;
using camera::test::random_bytes;
using test::spit;
using test::TemporaryFolder;

struct Case {
  FrameFormat format;
  std::size_t pixel_bytes;
};
class RoundTripTest : public testing::TestWithParam<Case> {};

/// Written and read again, a frame gives the same pixels, whatever its padding was.
TEST_P(RoundTripTest, WrittenPicturesComeBackAsTheyWere) {
  const auto [format, pixel_bytes] = GetParam();
  const auto stride = static_cast<std::uint32_t>(10 * pixel_bytes + 4);
  const TemporaryFolder folder;
  auto writer = ImageFolderWriter::create(folder / "camera").value();
  std::vector<Image> originals(3);
  for (unsigned i = 0; i < 3; ++i) {
    Packet packet = packet_of(header_of(format, 10, 6, stride), random_bytes(stride * 6, i), 7 + i);
    packet.arrival = Time{5s + i * 33ms};
    ASSERT_TRUE(camera::to_image(camera::parse_frame(packet.payload()).value(), originals[i]));
    ASSERT_TRUE(writer.write(packet));
  }
  ASSERT_TRUE(writer.close());

  ImageFolderSource::Options options;
  options.source = SourceId{4};
  if (format == FrameFormat::kZ16) options.deep = FrameFormat::kZ16;
  const auto source = ImageFolderSource::open(folder.path(), "camera/data.csv", options).value();
  Packet packet;
  for (unsigned i = 0; i < 3; ++i) {
    ASSERT_EQ(source->next(packet, 0s).value(), Poll::kPacket);
    EXPECT_EQ(packet.source, SourceId{4});
    EXPECT_EQ(packet.sequence, i);
    EXPECT_EQ(packet.arrival, Time{5s + i * 33ms});
    Image image;
    ASSERT_TRUE(camera::to_image(camera::parse_frame(packet.payload()).value(), image));
    EXPECT_EQ(image.format, originals[i].format);
    EXPECT_EQ(image.bytes, originals[i].bytes);
  }
  EXPECT_EQ(source->next(packet, 0s).value(), Poll::kEnd);
}
INSTANTIATE_TEST_SUITE_P(Formats, RoundTripTest,
                         testing::Values(Case{FrameFormat::kYuyv, 2}, Case{FrameFormat::kBgr, 3},
                                         Case{FrameFormat::kGrey, 1}, Case{FrameFormat::kY16, 2},
                                         Case{FrameFormat::kZ16, 2}));

TEST(ImageFolderWriter, RefusesStampsThatDoNotIncreaseAndFramesThatAreNone) {
  const TemporaryFolder folder;
  auto writer = ImageFolderWriter::create(folder / "camera").value();
  Packet packet = packet_of(header_of(FrameFormat::kGrey, 4, 4, 4), random_bytes(16, 1));
  packet.arrival = Time{1s};
  EXPECT_TRUE(writer.write(packet));
  EXPECT_FALSE(writer.write(packet));
  packet.arrival = Time{2s};
  packet.bytes.pop_back();
  EXPECT_FALSE(writer.write(packet));
  ASSERT_TRUE(writer.close());
  EXPECT_EQ(test::slurp(folder / "camera/data.csv"), "#timestamp [ns],filename\n1000000000,1000000000.png\n");
}

TEST(ImageIndex, ReadsEurocsOwn) {
  std::vector<ImageIndexEntry> entries;
  ASSERT_TRUE(
      parse_image_index("#timestamp [ns],filename\r\n1403636579763555584,1403636579763555584.png\r\n"
                        "1403636579813555456,1403636579813555456.png",
                        "data.csv", entries));
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].stamp, Time{Duration{1403636579763555584}});
  EXPECT_EQ(entries[1].file, "1403636579813555456.png");
}

TEST(ImageIndex, KeepsWhatIsBeforeAFault) {
  for (const char* bad :
       {"x,b.png", "5,b.png", "9", "9,../b.png", "9,/b.png", "9,b.png,1", "9223372036854775807,b.png"}) {
    std::vector<ImageIndexEntry> entries;
    EXPECT_FALSE(parse_image_index(std::string("5,a.png\n") + bad + "\n", "data.csv", entries)) << bad;
    EXPECT_EQ(entries.size(), 1U) << bad;
  }
}

TEST(ImageFolderSource, GoesOnAfterAPictureThatIsNone) {
  const TemporaryFolder folder;
  auto writer = ImageFolderWriter::create(folder / "camera").value();
  for (int i = 1; i <= 3; ++i) {
    Packet packet = packet_of(header_of(FrameFormat::kGrey, 4, 4, 4), random_bytes(16, 1));
    packet.arrival = Time{i * 1s};
    ASSERT_TRUE(writer.write(packet));
  }
  ASSERT_TRUE(writer.close());
  spit(folder / "camera/data/2000000000.png", "no picture");
  const auto source = ImageFolderSource::open(folder.path(), "camera/data.csv", {}).value();
  Packet packet;
  EXPECT_EQ(source->next(packet, 0s).value(), Poll::kPacket);
  const auto damaged = source->next(packet, 0s);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().where.find("2000000000.png"), std::string::npos);
  EXPECT_EQ(source->next(packet, 0s).value(), Poll::kPacket);
  EXPECT_EQ(source->next(packet, 0s).value(), Poll::kEnd);
}

}  // namespace
}  // namespace cairn::recording
