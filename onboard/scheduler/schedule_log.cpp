// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/schedule_log.hpp"

#include <algorithm>
#include <charconv>
#include <span>

#include "hal/files/file.hpp"

namespace cairn::scheduler {
namespace {

constexpr std::string_view kMagic = "cairn-schedule 1";
constexpr std::size_t kMaxWords = 3 + TickRecord::kSlots;

/// The words of one line; more than kMaxWords are left out, and noticed by their number.
struct Words {
  std::array<std::string_view, kMaxWords + 1> at{};
  std::size_t count = 0;

  explicit Words(std::string_view line) {
    while (!line.empty() && count <= kMaxWords) {
      const std::size_t end = std::min(line.find(' '), line.size());
      if (end > 0) at[count++] = line.substr(0, end);
      line.remove_prefix(std::min(end + 1, line.size()));
    }
  }
};

template <class T>
bool read(std::string_view word, T& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

/// One line after another, into a log.
class Parser {
 public:
  bool line(std::string_view text) {
    const Words words(text);
    if (words.count == 0) return true;
    if (words.at[0] == "task") return task(words);
    if (words.at[0] == "end") return end(words);
    return tick(words);
  }
  [[nodiscard]] bool complete() const {
    return !log.tasks.empty() && std::all_of(ended_.begin(), ended_.end(), [](bool e) { return e; });
  }
  [[nodiscard]] bool full() const { return ticks_ > kMaxLogTicks || releases_ > kMaxLogReleases; }

  ScheduleLog log;

 private:
  bool task(const Words& w) {
    std::size_t number = 0;
    std::int64_t first = 0, period = 0;
    if (w.count != 5 || !read(w.at[1], number) || !read(w.at[3], first) || !read(w.at[4], period)) return false;
    if (number != log.tasks.size() || number >= kMaxLogTasks || period <= 0 || first < 0) return false;
    log.tasks.push_back({std::string(w.at[2]), {Time{Duration{first}}, Duration{period}}, {}, 0});
    ended_.push_back(false);
    return true;
  }

  bool tick(const Words& w) {
    std::size_t number = 0;
    TickRecord record;
    if (w.count < 3 || w.count > kMaxWords || !read(w.at[0], number) || number >= log.tasks.size() || ended_[number])
      return false;
    if (!read(w.at[1], record.index) || !read(w.at[2], record.skipped)) return false;
    for (std::size_t i = 3; i < w.count; ++i)
      if (!read(w.at[i], record.slots[i - 3])) return false;
    TaskLog& task = log.tasks[number];
    const std::uint64_t first_free = task.ticks.empty() ? 0 : task.ticks.back().index + 1;
    if (!possible(task, record.index) || record.index < first_free || record.skipped > record.index - first_free)
      return false;
    ++ticks_;
    task.ticks.push_back(record);
    return true;
  }

  bool end(const Words& w) {
    std::size_t number = 0;
    if (w.count != 3 || !read(w.at[1], number) || number >= log.tasks.size() || ended_[number]) return false;
    TaskLog& task = log.tasks[number];
    ended_[number] = true;
    if (!read(w.at[2], task.end) || !possible(task, task.end)) return false;
    releases_ += std::min(task.end, kMaxLogReleases + 1);
    return task.ticks.empty() || task.end > task.ticks.back().index;
  }

  /// Its release lies within what Time can hold.
  static bool possible(const TaskLog& task, std::uint64_t index) {
    const auto room = static_cast<std::uint64_t>((Time::max() - task.releases.first) / task.releases.period);
    return index < room;
  }

  std::vector<bool> ended_;
  std::size_t ticks_ = 0;
  std::uint64_t releases_ = 0;
};

}  // namespace

const TaskLog* ScheduleLog::find(std::string_view name) const {
  const auto found = std::find_if(tasks.begin(), tasks.end(), [&](const TaskLog& t) { return t.name == name; });
  return found == tasks.end() ? nullptr : &*found;
}

Result<ScheduleLog> parse_schedule_log(std::string_view text) {
  Parser parser;
  for (std::uint64_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const bool understood = number == 1 ? line == kMagic : parser.line(line);
    if (!understood)
      return Error{Errc::kMalformed, "not a line of a schedule log", {}, {}, "line " + std::to_string(number)};
    if (parser.full())
      return Error{Errc::kLimit, "too many ticks for any run", {}, {}, "line " + std::to_string(number)};
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!parser.complete())
    return Error{Errc::kTruncated,
                 "the schedule log has no end",
                 {},
                 {},
                 "the run was killed; without --schedule, virtual time decides"};
  return std::move(parser.log);
}

Result<ScheduleLog> load_schedule_log(const std::filesystem::path& file) {
  const auto text = read_file(file, kMaxLogBytes);
  if (!text) return text.error();
  auto log = parse_schedule_log({reinterpret_cast<const char*>(text->data()), text->size()});
  if (!log) return at(file.string(), log.error());
  return log;
}

void ScheduleLogWriter::task(std::size_t number, std::string_view name, const Releases& releases) {
  if (number == 0) out_ << kMagic << '\n';
  out_ << "task " << number << ' ' << name << ' ' << releases.first.time_since_epoch().count() << ' '
       << releases.period.count() << '\n';
}

void ScheduleLogWriter::tick(std::size_t task, const TickRecord& record) {
  out_ << task << ' ' << record.index << ' ' << record.skipped;
  std::size_t used = record.slots.size();
  while (used > 0 && record.slots[used - 1] == 0) --used;
  for (std::size_t i = 0; i < used; ++i) out_ << ' ' << record.slots[i];
  out_ << '\n';
}

void ScheduleLogWriter::end(std::size_t task, std::uint64_t index) { out_ << "end " << task << ' ' << index << '\n'; }

Result<void> ScheduleLogWriter::close() {
  out_.close();
  if (out_.fail())
    return Error{Errc::kIo, "the schedule log could not be written", file_.string(), {}, "is the disk full?"};
  return {};
}

}  // namespace cairn::scheduler
