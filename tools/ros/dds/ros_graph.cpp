// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/ros_graph.hpp"

#include <graph.h>         // of idl/graph.idl
#include <graph_humble.h>  // of idl/graph_humble.idl

#include <cstring>
#include <span>

#include "tools/ros/messages/arena.hpp"

namespace cairn::ros {
namespace {

constexpr const char* kHash = "RIHS01_c873aaadedd207637953175d9a63b503342654f828afdeae79f92e252d46e9a1";

dds_topic_descriptor_t humble_descriptor() {
  dds_topic_descriptor_t descriptor = rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo__desc;
  descriptor.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
  return descriptor;
}

/// ROS's id of an endpoint is DDS's, with zeros behind it where it is longer.
template <class Gid>
Result<void> set(Gid& gid, dds_entity_t entity) {
  dds_guid_t guid{};
  if (const auto got = dds_get_guid(entity, &guid); got != DDS_RETCODE_OK) return dds_error("id of an endpoint", got);
  static_assert(sizeof(gid.data) >= sizeof(guid.v));
  std::memcpy(gid.data, guid.v, sizeof guid.v);
  return {};
}

template <class Sequence>
Result<void> set_all(Sequence& sequence, std::span<const dds_entity_t> entities, Arena& arena) {
  const auto gids = arena.sequence(sequence, entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (const auto done = set(gids[i], entities[i]); !done) return done;
  return {};
}

/// The same for both forms.
template <class Message>
Result<void> write(dds_entity_t writer, const RosParticipant& participant, const std::string& node_namespace,
                   const std::string& name) {
  Arena arena;
  Message message{};
  if (const auto done = set(message.gid, participant.handle()); !done) return done;
  auto& node = arena.sequence(message.node_entities_info_seq, 1)[0];
  node_namespace.copy(node.node_namespace, sizeof node.node_namespace - 1);
  name.copy(node.node_name, sizeof node.node_name - 1);
  if (const auto done = set_all(node.writer_gid_seq, participant.writers(), arena); !done) return done;
  if (const auto done = set_all(node.reader_gid_seq, participant.readers(), arena); !done) return done;
  const dds_return_t written = dds_write(writer, &message);
  return written == DDS_RETCODE_OK ? Result<void>{} : dds_error("ros_discovery_info", written);
}

}  // namespace

const RosType& graph_type(GraphForm form) {
  static const dds_topic_descriptor_t humble = humble_descriptor();
  static const RosType of_humble{"rmw_dds_common/msg/ParticipantEntitiesInfo", kHash, &humble};
  static const RosType of_iron{"rmw_dds_common/msg/ParticipantEntitiesInfo", kHash,
                               &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc};
  return form == GraphForm::kHumble ? of_humble : of_iron;
}

Result<RosGraph> RosGraph::open(RosParticipant& participant, GraphForm form, std::string node_namespace,
                                std::string name) {
  RosGraph graph(participant, form, std::move(node_namespace), std::move(name));
  if (form == GraphForm::kNone) return graph;
  const auto writer = participant.graph_writer(graph_type(form));
  if (!writer) return writer.error();
  graph.writer_ = *writer;
  return graph;
}

Result<void> RosGraph::tick() {
  const std::size_t endpoints = participant_->writers().size() + participant_->readers().size();
  if (form_ == GraphForm::kNone || endpoints == endpoints_) return {};
  endpoints_ = endpoints;
  if (form_ == GraphForm::kHumble)
    return write<rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo_>(writer_, *participant_, namespace_, name_);
  return write<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_>(writer_, *participant_, namespace_, name_);
}

}  // namespace cairn::ros
