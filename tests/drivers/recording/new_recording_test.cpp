// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/new_recording.hpp"

#include <gmock/gmock.h>

#include <string>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct NewRecordingTest : ::testing::Test {
  /// A recording of one line, with a mark of its own.
  void write_into(const fs::path& dir, const std::string& notes) {
    Recording r;
    r.robot = "robot_1";
    r.notes = notes;
    r.sources.push_back({"gpio", kGpio, "gpio.csv", "base_link", ""});
    auto writer = RecordingWriter::create(dir, r);
    ASSERT_TRUE(writer) << to_string(writer.error());
    ASSERT_TRUE(writer->close());
  }
  void make(const std::string& notes, Overwrite overwrite = Overwrite::kNo) {
    auto made = NewRecording::begin(place, overwrite);
    ASSERT_TRUE(made) << to_string(made.error());
    write_into(made->folder(), notes);
    const auto finished = made->finish();
    ASSERT_TRUE(finished) << to_string(finished.error());
  }
  [[nodiscard]] std::string notes() const {
    const auto r = load_recording(place);
    return r ? r->notes : to_string(r.error());
  }
  test::TemporaryFolder folder;
  fs::path place = folder / "r";
};

TEST_F(NewRecordingTest, AppearsWhenItIsWhole) {
  auto made = NewRecording::begin(place, Overwrite::kNo).value();
  write_into(made.folder(), "new");
  EXPECT_FALSE(fs::exists(place));
  ASSERT_TRUE(made.finish());
  EXPECT_EQ(notes(), "new");
  EXPECT_FALSE(fs::exists(folder / "r.unfinished"));
}

TEST_F(NewRecordingTest, WhatComesToNothingKeepsTheOldOne) {
  make("old");
  {
    auto made = NewRecording::begin(place, Overwrite::kYes).value();
    write_into(made.folder(), "half");
  }
  EXPECT_EQ(notes(), "old");
  EXPECT_FALSE(fs::exists(folder / "r.unfinished"));
}

TEST_F(NewRecordingTest, AnOldOneIsRefusedOrReplacedWhole) {
  make("old");
  for (const char* file : {"ground_truth.tum", "profile.yaml", "schedule.log", "labels/1.png", "boxes.csv",
                           "true_boxes.csv", "resume/map.cairn"})
    test::spit(place / file, "of the old recording");
  test::spit(place / "notes.txt", "mine");
  const auto refused = NewRecording::begin(place, Overwrite::kNo);
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), AllOf(HasSubstr("there is a recording already"), HasSubstr("--overwrite")));
  make("new", Overwrite::kYes);
  EXPECT_EQ(notes(), "new");
  EXPECT_EQ(test::slurp(place / "notes.txt"), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(place), {}), 3) << "index, edges and notes";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST_F(NewRecordingTest, AnOldOneWithADamagedIndexIsReplaced) {
  make("old");
  test::spit(place / "recording.yaml", "robot: [");
  make("new", Overwrite::kYes);
  EXPECT_EQ(notes(), "new");
}

TEST_F(NewRecordingTest, AFileOfItsNameIsNotReplacedUnlessToldSo) {
  test::spit(place / "gpio.csv", "mine");
  auto made = NewRecording::begin(place, Overwrite::kNo).value();
  write_into(made.folder(), "new");
  const auto refused = made.finish();
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("the recording is in"));
  EXPECT_EQ(test::slurp(place / "gpio.csv"), "mine");
  EXPECT_TRUE(load_recording(folder / "r.unfinished")) << "what was made is kept";
}

TEST_F(NewRecordingTest, WhatIsNotOfTheRecordingStays) {
  test::spit(place / "mine/notes.txt", "mine");
  make("new");
  EXPECT_EQ(notes(), "new");
  EXPECT_EQ(test::slurp(place / "mine/notes.txt"), "mine");
}

TEST_F(NewRecordingTest, AFolderOfRecordingsDoesNotBecomeOne) {
  write_into(place / "robot_1", "inner");
  for (const Overwrite overwrite : {Overwrite::kNo, Overwrite::kYes}) {
    const auto refused = NewRecording::begin(place, overwrite);
    ASSERT_FALSE(refused);
    EXPECT_THAT(to_string(refused.error()), HasSubstr("the folder holds recordings"));
  }
  EXPECT_FALSE(fs::exists(folder / "r.unfinished"));
}

TEST_F(NewRecordingTest, ALinkToAFolderOutsideIsNotFollowed) {
  make("old");
  test::spit(folder / "outside/data.csv", "mine");
  fs::create_directory_symlink(folder / "outside", place / "camera");
  test::spit(place / "recording.yaml",
             "robot: a\nstart_utc: 1970-01-01T00:00:01.000000000Z\nrealtime_offset_ns: 0\nsources:\n"
             "  - {id: c, kind: camera, file: camera/data.csv, frame: camera}\n");
  make("new", Overwrite::kYes);
  EXPECT_EQ(test::slurp(folder / "outside/data.csv"), "mine");
}

}  // namespace
}  // namespace cairn::recording
