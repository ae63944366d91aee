// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/report_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "onboard/report/notes/notes.hpp"
#include "onboard/report/page/html_text.hpp"
#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Empty when every element is closed in the right order and every attribute's value is quoted.
std::string structure_fault(const std::string& page) {
  static const std::set<std::string> kVoid{"!doctype", "meta", "br"};
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "a tag does not end";
    const std::string tag = page.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    at = name == "style" ? page.find("</style", end) : end;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "a quote is open in <" + tag;
    if (tag.find('<') != std::string::npos) return "a tag within a tag: <" + tag;
    if (name[0] == '/') {
      if (open.empty() || open.back() != name.substr(1)) return "<" + tag + "> closes nothing";
      open.pop_back();
    } else if (tag.back() != '/' && kVoid.count(name) == 0) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

TEST(ReportHtml, IsOneWellFormedPageOfAllParts) {
  const auto run = sample_run(200);
  const std::string page = to_html(run->report).value();
  EXPECT_EQ(structure_fault(page), "");
  for (const char* part :
       {"Worth a look", "data:image/png;base64,iVBORw0KGgo", "class=\"trajectory\"", "class=\"truth\"", "Accuracy",
        "Timing", "class=\"bars\"", "Schedule", "hold: lidar_silent", "nothing 560, peer tiles 40", "Events and faults",
        "3 packets lost", "Peers", "robot_3", "max_range_m", "9f86d081884c7d65"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(ReportHtml, ShowsWhereThePeopleWent) {
  const auto run = sample_run(50);
  EXPECT_THAT(to_html(run->report).value(), Not(HasSubstr("class=\"person\"")));
  PeopleStats& people = run->report.people.emplace();
  people.tracks = 2;
  people.nearest_m = 1.25;
  people.paths = {{{1, 1}, {2, 1}}, {{0, 3}, {0, 4}}};
  const std::string page = to_html(run->report).value();
  EXPECT_EQ(structure_fault(page), "");
  std::size_t paths = 0;
  for (std::size_t at = page.find("<path class=\"person\""); at != std::string::npos; ++paths)
    at = page.find("<path class=\"person\"", at + 1);
  EXPECT_EQ(paths, 2U);
  EXPECT_THAT(page, HasSubstr("nearest 1.25\u202fm"));
}

TEST(ReportHtml, LoadsNothingAndRunsNothing) {
  const std::string page = to_html(sample_run(50)->report).value();
  for (const char* foreign : {"http:", "https:", "//cdn", "<script", "<link", "@import", "url(", "<iframe", " onload"})
    EXPECT_THAT(page, Not(HasSubstr(foreign)));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(ReportHtml, EscapesEveryTextFromOutside) {
  const auto run = sample_run(50, 0.4, true);
  const std::string page = to_html(run->report).value();
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("alert(\"")));
  EXPECT_EQ(page.find('\x01'), std::string::npos);
  EXPECT_EQ(structure_fault(page), "");
}

TEST(ReportHtml, OfARunThatDidNothingIsStillAPage) {
  const std::string page = to_html(RunReport{}).value();
  EXPECT_EQ(structure_fault(page), "");
  EXPECT_THAT(page, HasSubstr("<li class=\"bad\">No scan arrived"));
  EXPECT_THAT(page, HasSubstr("<div class=\"tile bad\"><span>scans"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("Accuracy")));
}

TEST(ReportHtml, OfOnePoseOrALostTrajectoryIsStillAPage) {
  auto run = sample_run(1);
  EXPECT_EQ(structure_fault(to_html(run->report).value()), "");
  run->report.trajectory[0].T_odom_base.mean = SE3(Eigen::Quaterniond::Identity(), {NAN, 0, 0});
  EXPECT_EQ(structure_fault(to_html(run->report).value()), "");
}

/// The row of a task, tags left out.
std::string row_of(const std::string& page, const std::string& task) {
  const std::size_t begin = page.find("<tr><td class=\"l\">" + task + "</td>", page.find("<h2>Schedule"));
  std::string text;
  bool tag = false;
  for (const char c : page.substr(begin, page.find("</tr>", begin) - begin)) {
    if (c == '<') text += text.empty() || text.back() == ' ' ? "" : " ";
    tag = c == '<' || (tag && c != '>');
    if (!tag && c != '>') text += c;
  }
  return text;
}

TEST(ReportHtml, ShowsEveryTaskAgainstItsDeadline) {
  RunReport report;
  TaskFigures& task = report.tasks.emplace_back();
  task.spec.name = "drive", task.spec.rate_hz = 500, task.spec.deadline_ms = 2;
  for (int i = 0; i < 1000; ++i) task.stats.response.record(std::chrono::milliseconds(i == 999 ? 3 : 1));
  task.stats.wake.record(std::chrono::microseconds(500));
  task.stats.ticks = 1000, task.stats.warm_ticks = 800, task.stats.misses = 1, task.stats.slips = 4,
  task.stats.soft_overruns = 5;
  task.stats.hard_overruns = 6, task.stats.demotions = 7, task.stats.allocations = 8, task.stats.major_faults = 9;
  task.stats.minor_faults = 10, task.stats.involuntary_switches = 11;
  const std::string page = to_html(report).value();
  EXPECT_THAT(row_of(page, "drive"),
              testing::MatchesRegex(" ?drive 500 1.{1,8}000 1.0. 1.0. 1.0. 3.0. 2.00 0.50. 1 4 5 6 7 8 9 10 11 ?"));
  EXPECT_THAT(page, HasSubstr("<td class=\"bad\">3.0")) << "above the deadline";
  EXPECT_THAT(page, Not(HasSubstr("<td class=\"bad\">1.0")));
}

TEST(ReportHtml, OfARunWithoutAScanNothingIsGreen) {
  RunReport report;
  Monitor monitor;
  monitor.stage("decode", std::chrono::milliseconds(5)).record(std::chrono::milliseconds(1));
  report.monitor = &monitor;
  report.ticks = {.count = 5000, .missed = 0, .max_lateness = Duration{}};
  EXPECT_THAT(to_html(report).value(), Not(HasSubstr("tile good")));
  report.scans = 1;
  EXPECT_THAT(to_html(report).value(), HasSubstr("tile good"));
}

TEST(ReportHtml, ShowsEveryNoteWithItsRemedy) {
  const auto run = sample_run(100);
  const std::string page = to_html(run->report).value();
  const auto notes = notes_of(run->report);
  ASSERT_FALSE(notes.empty());
  for (const Note& note : notes) {
    EXPECT_THAT(page, HasSubstr(html::escape(note.text)));
    EXPECT_THAT(page, HasSubstr(html::escape(note.remedy)));
  }
}

TEST(ReportHtml, PointsOutModeDemotionsAndWhatWasShed) {
  RunReport report = uneventful();
  report.mode = "normal";
  report.tasks.emplace_back().spec.name = "mapping";
  report.shed = {{"nothing", 7}, {"peer tiles", 0}};
  EXPECT_THAT(to_html(report).value(), HasSubstr("Nothing to report"));
  report.mode = "stop", report.mode_cause = "estop_open";
  report.tasks.back().stats.demotions = 2;
  report.shed[1].second = 3;
  const std::string page = to_html(report).value();
  for (const char* note :
       {"<li class=\"warn\">The run ended in mode stop: estop_open", "<li class=\"bad\">Task mapping kept",
        "demoted 2 times", "3 scans were mapped while work was shed"})
    EXPECT_THAT(page, HasSubstr(note));
}

TEST(ReportHtml, PointsOutWhatDevicesLostAndNoZeros) {
  RunReport report = uneventful();
  report.losses = {{"lidar<1>", {{"kernel_drops", 0}, {"foreign", 0}}}};
  EXPECT_THAT(to_html(report).value(), HasSubstr("Nothing to report"));
  report.losses[0].second[0].second = 3;
  EXPECT_THAT(to_html(report).value(), HasSubstr("Device lidar&lt;1&gt; reports kernel_drops 3."));
}

TEST(ReportHtml, InVirtualTimeTasksHaveNoResponse) {
  RunReport report;
  report.tasks.emplace_back().spec.name = "drive";
  report.tasks.back().stats.ticks = 12;
  const std::string page = to_html(report).value();
  EXPECT_THAT(row_of(page, "drive"), HasSubstr("12 not measured"));
  EXPECT_THAT(page, HasSubstr("virtual time"));
}

TEST(ReportHtml, WhatWasNotMeasuredIsNoZero) {
  RunReport report;
  Monitor monitor;
  monitor.stage("packet_to_pose");
  report.monitor = &monitor;
  report.ticks.count = 5000;
  const std::string page = to_html(report).value();
  for (const char* text :
       {"<b>not measured</b><small>of 5\u202f000", "packet_to_pose</td><td>0</td><td colspan=\"8\">not",
        "distance</span><b>not measured", "packets lost: not measured", "latest tick</td><td>not measured",
        "iterations per scan</td><td>not measured"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, Not(HasSubstr("class=\"tile good\"")));
}

TEST(ReportHtml, OfAShortRunAllocationsAreNotMeasured) {
  RunReport report;
  TaskFigures& task = report.tasks.emplace_back();
  task.spec.name = "drive";
  task.stats.response.record(std::chrono::milliseconds(1));
  EXPECT_THAT(row_of(to_html(report).value(), "drive"), testing::EndsWith("– – – – – not measured "));
}

TEST(ReportHtml, PointsOutClaimsThatDoNotHold) {
  auto run = sample_run(300);
  EXPECT_THAT(to_html(run->report).value(), Not(HasSubstr("stated covariance is too small")));
  for (PoseEstimate& p : run->report.trajectory) p.T_odom_base.covariance *= 1e-4;
  EXPECT_THAT(to_html(run->report).value(), HasSubstr("stated covariance is too small: 3 sigma hold"));
}

TEST(ReportHtml, StaysSmallForALongRun) {
  auto run = sample_run(600);
  const std::size_t small = to_html(run->report)->size();
  run->report.trajectory.clear();
  run->report.ground_truth.clear();
  sample::drive(run->report, 20'000, 6e-4);
  EXPECT_LT(to_html(run->report)->size(), small + 600'000);
}

}  // namespace
}  // namespace cairn::report
