// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/label_folder.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/onboard/perception/networks/sample_labels.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::networks {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Image picture_of(std::int64_t stamp_ns) {
  Image picture;
  picture.resize(PixelFormat::kMono8, 8, 6);
  picture.stamp = Time{Duration{stamp_ns}};
  picture.source = SourceId{2};
  return picture;
}

TEST(LabelFolder, ARecordedSegmenterSaysWhatTheNetworkSaid) {
  const support::TemporaryFolder folder;
  auto writer = LabelFolderWriter::create(folder / "run/labels");
  ASSERT_TRUE(writer);
  LabelImage labels = test::sample_labels(4, 3);
  labels.stamp = Time{Duration{1'234'567'890'123}};
  ASSERT_TRUE(writer->write(labels));
  EXPECT_TRUE(fs::is_regular_file(folder / "run/labels/1234567890123.png"));

  RecordedSegmenter segmenter(folder / "run/labels");
  const auto again = segmenter.segment(picture_of(1'234'567'890'123));
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_EQ((*again)->classes, labels.classes);
  EXPECT_EQ((*again)->probabilities, labels.probabilities);
  EXPECT_EQ((*again)->stamp, labels.stamp);
  EXPECT_EQ((*again)->source, SourceId{2});
}

TEST(LabelFolder, APictureWithoutLabelsIsNotFound) {
  const support::TemporaryFolder folder;
  RecordedSegmenter segmenter(folder.path());
  EXPECT_EQ(segmenter.segment(picture_of(5)).error().code, Errc::kNotFound);
  std::ofstream(folder / "5.png") << "no PNG";
  const auto damaged = segmenter.segment(picture_of(5));
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, Errc::kUnsupported);
  EXPECT_THAT(to_string(damaged.error()), HasSubstr("5.png"));
}

TEST(LabelFolder, LabelsThatAreNoneLeaveNoFile) {
  const support::TemporaryFolder folder;
  auto writer = LabelFolderWriter::create(folder.path());
  LabelImage labels = test::sample_labels(4, 3);
  labels.probabilities.pop_back();
  EXPECT_EQ(writer->write(labels).error().code, Errc::kMalformed);
  EXPECT_EQ(writer->write(LabelImage()).error().code, Errc::kMalformed);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(LabelFolder, AFolderThatCannotBeMadeIsAnError) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(LabelFolderWriter::create(folder / "file/labels").error().code, Errc::kIo);
}

}  // namespace
}  // namespace cairn::networks
