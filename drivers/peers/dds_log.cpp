// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/dds_log.hpp"

#include <dds/ddsrt/log.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cairn::peer_link {

DdsLog::DdsLog(const Clock& clock, std::string program) : clock_(clock), program_(std::move(program)) {
  const auto sink = [](void* self, const dds_log_data_t* data) {
    // The message proper follows a header with time and thread.
    static_cast<DdsLog*>(self)->write({data->message, data->size});
  };
  dds_set_log_sink(sink, this);
  dds_set_trace_sink([](void*, const dds_log_data_t*) {}, this);  // the same lines once more
}

DdsLog::~DdsLog() {
  dds_set_log_sink(nullptr, nullptr);
  dds_set_trace_sink(nullptr, nullptr);
  sum_up();
}

void DdsLog::print(const std::vector<std::string>& lines) const {
  for (const std::string& line : lines) std::fprintf(stderr, "%s: DDS: %s\n", program_.c_str(), line.c_str());
}

void DdsLog::sum_up() {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  limiter_.finish(lines);
  print(lines);
}

void DdsLog::settle() {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  limiter_.settle(clock_.now(), lines);
  print(lines);
}

void DdsLog::write(std::string_view line) {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  limiter_.add(clock_.now(), line, lines);
  print(lines);
}

}  // namespace cairn::peer_link
