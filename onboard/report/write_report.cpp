// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/write_report.hpp"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/report/page/report_html.hpp"

namespace cairn::report {

double peak_rss_mb() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

Result<void> write_report(const RunReport& report, const std::filesystem::path& folder) {
  if (const auto written = write_file_atomic(folder / "report.json", to_text(to_json(report))); !written)
    return written;
  const auto page = to_html(report);
  if (!page) return page.error();
  return write_file_atomic(folder / "report.html", *page);
}

}  // namespace cairn::report
