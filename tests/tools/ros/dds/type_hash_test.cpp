// SPDX-License-Identifier: Apache-2.0
// ROS's type hashes (RIHS01, of rosidl) computed from the IDL: what the program's constants are compared with. So
// a field of another name, type or place is found here.
#include <gtest/gtest.h>
#include <openssl/sha.h>

#include <array>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "hal/files/file.hpp"
#include "tests/support/places.hpp"
#include "tools/ros/dds/ros_graph.hpp"
#include "tools/ros/dds/ros_type.hpp"

namespace cairn::ros {
namespace {

/// A field as rosidl describes it.
struct Field {
  std::string name;
  int type_id = 0, capacity = 0, text_capacity = 0;
  std::string nested{};  // "std_msgs/msg/Header"
};
using Types = std::map<std::string, std::vector<Field>>;

// rosidl_runtime: type_description_interfaces/msg/FieldType
const std::map<std::string, int> kBaseTypes{{"int8", 2},    {"uint8", 3},          {"int32", 6},    {"uint32", 7},
                                            {"float", 10},  {"double", 11},        {"boolean", 15}, {"octet", 16},
                                            {"string", 17}, {"bounded string", 21}};
constexpr int kArray = 48, kUnboundedSequence = 144;

/// "std_msgs::msg::dds_::Header_" of any package, "Pose_" of `package` → "std_msgs/msg/Header".
std::string ros_name(const std::string& idl_name, const std::string& package) {
  std::smatch parts;
  static const std::regex qualified("(\\w+)::msg::dds_::(\\w+)_"), plain("(\\w+)_");
  if (std::regex_match(idl_name, parts, qualified)) return parts[1].str() + "/msg/" + parts[2].str();
  EXPECT_TRUE(std::regex_match(idl_name, parts, plain)) << idl_name;
  return package + "/msg/" + parts[1].str();
}

Field field_of(std::string type, const std::string& name, const std::string& count, const std::string& package) {
  Field field{.name = name};
  std::smatch parts;
  static const std::regex sequence("sequence<(.*)>");
  if (std::regex_match(type, parts, sequence)) {
    field.type_id += kUnboundedSequence;
    type = parts[1].str();
  }
  if (!count.empty()) {
    field.type_id += kArray;
    field.capacity = std::stoi(count);
  }
  static const std::regex bounded_text("string<(\\d+)>");
  if (std::regex_match(type, parts, bounded_text)) {
    field.text_capacity = std::stoi(parts[1]);
    type = "bounded string";
  }
  const auto base = kBaseTypes.find(type);
  field.type_id += base != kBaseTypes.end() ? base->second : 1;
  if (base == kBaseTypes.end()) field.nested = ros_name(type, package);
  return field;
}

/// Module by module, struct by struct: the file has no other form.
Types parse(const std::string& idl) {
  Types types;
  static const std::regex word("module (\\w+) \\{ module msg|struct (\\w+)_ \\{([^}]*)\\}");
  static const std::regex member("([\\w:<>]+) (\\w+)(\\[(\\d+)\\])?;");
  std::string package;
  for (std::sregex_iterator found(idl.begin(), idl.end(), word), end; found != end; ++found) {
    if ((*found)[1].matched) package = (*found)[1];
    if (!(*found)[2].matched) continue;
    auto& fields = types[package + "/msg/" + (*found)[2].str()];
    const std::string body = (*found)[3];
    for (std::sregex_iterator one(body.begin(), body.end(), member); one != end; ++one)
      fields.push_back(field_of((*one)[1], (*one)[2], (*one)[4], package));
  }
  return types;
}

void append_fields(std::ostream& out, const std::string& name, const std::vector<Field>& fields) {
  out << R"({"type_name": ")" << name << R"(", "fields": [)";
  for (const Field& field : fields)
    out << (&field == fields.data() ? "" : ", ") << R"({"name": ")" << field.name << R"(", "type": {"type_id": )"
        << field.type_id << R"(, "capacity": )" << field.capacity << R"(, "string_capacity": 0, "nested_type_name": ")"
        << field.nested << R"("}})";
  out << "]}";
}

void gather(const Types& types, const std::string& name, std::set<std::string>& all) {
  for (const Field& field : types.at(name))
    if (!field.nested.empty() && all.insert(field.nested).second) gather(types, field.nested, all);
}

std::string hash_of(const Types& types, const std::string& name) {
  std::set<std::string> nested;
  gather(types, name, nested);
  std::ostringstream text;
  text << R"({"type_description": )";
  append_fields(text, name, types.at(name));
  text << R"(, "referenced_type_descriptions": [)";
  for (const std::string& other : nested) {
    text << (other == *nested.begin() ? "" : ", ");
    append_fields(text, other, types.at(other));
  }
  text << "]}";
  const std::string json = text.str();
  std::array<unsigned char, SHA256_DIGEST_LENGTH> sum{};
  SHA256(reinterpret_cast<const unsigned char*>(json.data()), json.size(), sum.data());
  std::string hex = "RIHS01_";
  for (const unsigned byte : sum) {
    hex += "0123456789abcdef"[byte >> 4U];
    hex += "0123456789abcdef"[byte & 15U];
  }
  return hex;
}

class TypeHash : public ::testing::Test {
 protected:
  static std::string idl(const char* file) {
    const auto bytes = read_file(places::source() / "tools/ros/idl" / file, 1U << 20U).value();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  void expect_like_ros(const RosType& type) {
    SCOPED_TRACE(type.name);
    EXPECT_EQ(hash_of(types_, type.name), type.hash);
    EXPECT_EQ(ros_name(type.descriptor->m_typename, ""), type.name);
    EXPECT_EQ(type.descriptor->m_nkeys, 0U);
  }
  const Types types_ = parse(idl("ros2.idl") + idl("graph.idl"));
};

TEST_F(TypeHash, OfEachTypeIsThatOfItsIdl) {
  expect_like_ros(ros_type<BoolMessage>());
  expect_like_ros(ros_type<CameraInfo>());
  expect_like_ros(ros_type<CompressedImage>());
  expect_like_ros(ros_type<DiagnosticArray>());
  expect_like_ros(ros_type<JointState>());
  expect_like_ros(ros_type<MarkerArray>());
  expect_like_ros(ros_type<OccupancyGrid>());
  expect_like_ros(ros_type<Octomap>());
  expect_like_ros(ros_type<Odometry>());
  expect_like_ros(ros_type<PointCloud2>());
  expect_like_ros(ros_type<PoseWithCovarianceStamped>());
  expect_like_ros(ros_type<TfMessage>());
  expect_like_ros(ros_type<Twist>());
  expect_like_ros(ros_type<TwistStamped>());
  expect_like_ros(graph_type(GraphForm::kIron));
}

/// Types that are only parts of others; published by ROS.
TEST_F(TypeHash, OfPartsIsThatOfRos) {
  EXPECT_EQ(hash_of(types_, "std_msgs/msg/Header"),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(hash_of(types_, "geometry_msgs/msg/TransformStamped"),
            "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206");
  EXPECT_EQ(hash_of(types_, "visualization_msgs/msg/Marker"),
            "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0");
}

}  // namespace
}  // namespace cairn::ros
