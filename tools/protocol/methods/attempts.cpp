// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/methods/attempts.hpp"

#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "tools/protocol/pairs/json.hpp"

namespace cairn::protocol {
namespace {

constexpr std::uint64_t kMaxBytes = 64U << 20U;  // of a file of attempts: a bound on memory

Json to_json(const Attempt& a) {
  Json json = {{"start", a.start},         {"T_a_b", pose_to_json(a.T_a_b)}, {"error_m", a.error.m},
               {"error_deg", a.error.deg}, {"seconds", a.seconds},           {"iterations", a.iterations},
               {"accepted", a.accepted}};
  if (a.rms_m) json["rms_m"] = *a.rms_m;
  return json;
}

Attempt attempt_from(const Json& json) {
  Attempt a{json.at("start"),
            pose_from_json(json.at("T_a_b")),
            {json.at("error_m"), json.at("error_deg")},
            json.at("seconds"),
            json.at("iterations"),
            json.at("accepted"),
            {}};
  if (json.contains("rms_m")) a.rms_m = json["rms_m"].get<double>();
  return a;
}

}  // namespace

Result<void> save_runs(const std::vector<MethodRun>& runs, const std::filesystem::path& path) {
  Json all = Json::array();
  for (const MethodRun& run : runs) {
    Json json = {{"method", run.method}, {"preparation_s", run.preparation_s}};
    if (run.correspondences) json["correspondences"] = *run.correspondences;
    for (const Attempt& a : run.attempts) json["attempts"].push_back(to_json(a));
    all.push_back(std::move(json));
  }
  return write_file_atomic(path, all.dump());
}

Result<std::vector<MethodRun>> load_runs(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxBytes);
  if (!bytes) return bytes.error();
  std::vector<MethodRun> runs;
  try {
    const Json all = Json::parse(reinterpret_cast<const char*>(bytes->data()),
                                 reinterpret_cast<const char*>(bytes->data() + bytes->size()));
    for (const Json& json : all) {
      MethodRun run{json.at("method"), json.at("preparation_s"), {}, {}};
      if (json.contains("correspondences")) run.correspondences = json["correspondences"].get<double>();
      for (const Json& a : json.at("attempts")) run.attempts.push_back(attempt_from(a));
      runs.push_back(std::move(run));
    }
  } catch (const nlohmann::json::exception& fault) {
    return Error{Errc::kMalformed, "not the outcome of a run", path.string(), {}, fault.what()};
  }
  return runs;
}

}  // namespace cairn::protocol
