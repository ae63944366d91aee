// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/answer_file.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "drivers/recording/formats/text_lines.hpp"
#include "hal/files/file.hpp"
#include "tools/cli/evaluate/people_file.hpp"

namespace cairn::cli {
namespace {

constexpr std::size_t kAnswerColumns = 8;
constexpr std::string_view kAnswerHeader = "t,camera,x,y,z,verdict,score,distance_m";

Result<AnswerRow> parse_answer(const recording::LineReader& lines, std::string_view line) {
  std::string_view parts[kAnswerColumns];
  if (recording::split(line, ',', parts) != kAnswerColumns)
    return lines.fault(Errc::kMalformed, "not an answer", std::string(kAnswerHeader) + " expected");
  const auto ns = recording::parse_seconds(parts[0]);
  if (!ns || std::abs(*ns) > kLatest_ns) return lines.fault(Errc::kMalformed, "not a time in seconds");
  if (parts[1] != "visible" && parts[1] != "thermal")
    return lines.fault(Errc::kMalformed, "not a camera", "visible or thermal");
  if (parts[5] != "person" && parts[5] != "silence")
    return lines.fault(Errc::kMalformed, "not a verdict", "person or silence");
  const auto x = recording::parse_number(parts[2]), y = recording::parse_number(parts[3]);
  const auto z = recording::parse_number(parts[4]);
  const auto score = recording::parse_number(parts[6]), distance = recording::parse_number(parts[7]);
  const auto near = [](const std::optional<double>& m) { return m && std::abs(*m) <= kFarthest_m; };
  if (!near(x) || !near(y) || !near(z))
    return lines.fault(Errc::kMalformed, "not a usable position", "x, y and z in metres");
  if (!score || !(*score >= 0 && *score <= 1)) return lines.fault(Errc::kMalformed, "not a score", "from 0 to 1");
  if (!distance || !(*distance >= 0 && *distance <= kFarthest_m))
    return lines.fault(Errc::kMalformed, "not a distance", "metres, from 0 on");
  return AnswerRow{Time(Duration(*ns)), parts[1] == "thermal", {*x, *y}, *z, parts[5] == "person", *score, *distance};
}

}  // namespace

Result<std::vector<AnswerRow>> parse_answers(std::string_view text, std::string_view name) {
  recording::LineReader lines(text, name);
  const auto header = lines.next();
  if (!header || recording::trimmed(*header) != kAnswerHeader)
    return Error{Errc::kMalformed,
                 "not a table of answers",
                 std::string(name),
                 {},
                 "it begins with " + std::string(kAnswerHeader)};
  std::vector<AnswerRow> rows;
  while (const auto line = lines.next()) {
    if (recording::trimmed(*line).empty()) continue;
    const auto row = parse_answer(lines, recording::trimmed(*line));
    if (!row) return row.error();
    rows.push_back(*row);
  }
  return rows;
}

Result<std::vector<AnswerRow>> read_answers(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMaxAnswerBytes);
  if (!bytes) return at(file.string(), bytes.error());
  return parse_answers({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string());
}

}  // namespace cairn::cli
