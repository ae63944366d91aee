// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/qos.hpp"

#include <string>

namespace cairn::ros {
namespace {

// A reader that does not acknowledge must not stop the program.
constexpr dds_duration_t kMostBlocking = DDS_MSECS(5);

Qos with_user_data(const std::string& text) {
  Qos qos(dds_create_qos());
  dds_qset_userdata(qos.get(), text.data(), text.size());
  return qos;
}

int depth_of(TopicUse use) {
  switch (use) {
    case TopicUse::kEvent:
      return 10;
    case TopicUse::kStream:
      return 5;
    case TopicUse::kTf:
      return 100;
    case TopicUse::kLatched:
    case TopicUse::kCommand:
      return 1;
  }
  return 1;
}

}  // namespace

Qos participant_qos() { return with_user_data("enclave=/;"); }

Qos qos_of(TopicUse use, const char* type_hash) {
  Qos qos = with_user_data("typehash=" + std::string(type_hash) + ";");
  const bool reliable = use != TopicUse::kCommand, latched = use == TopicUse::kLatched;
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, kMostBlocking);
  dds_qset_durability(qos.get(), latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth_of(use));
  if (latched)
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain_cdr);
  return qos;
}

}  // namespace cairn::ros
