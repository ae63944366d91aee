// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/report_html.hpp"

#include "onboard/report/page/html_sections.hpp"
#include "onboard/report/page/html_text.hpp"
#include "onboard/report/page/report_style.hpp"
#include "onboard/report/page/svg_map.hpp"

namespace cairn::report {
namespace {

std::string head(const RunReport& report) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "img-src "
         "data:\">\n<title>" +
         html::escape(report.robot) + " · Cairn</title>\n<style>" + html::kStyle + "</style></head>\n<body><main>\n";
}

std::string foot(const RunReport& report) {
  std::string s = "<footer>Cairn " + html::escape(report.version);
  if (!report.output_sha256.empty())
    s += " · SHA-256 of the output: <code>" + html::escape(report.output_sha256) + "</code>";
  return s + "</footer>\n</main></body></html>\n";
}

}  // namespace

Result<std::string> to_html(const RunReport& report) {
  const auto map = html::svg_map(report);
  if (!map) return map.error();
  const Accuracy accuracy = accuracy_of(report);
  return head(report) + html::header(report) + html::tiles(report, accuracy) + html::notes(report) +
         html::map_section(report, *map) + html::accuracy_section(report, accuracy) + html::timing_section(report) +
         html::schedule_section(report) + html::events_section(report) + html::peers_section(report) +
         html::details_section(report) + foot(report);
}

}  // namespace cairn::report
