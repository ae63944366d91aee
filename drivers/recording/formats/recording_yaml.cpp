// SPDX-License-Identifier: Apache-2.0
// The text of recording.yaml: reading with every fault at once, and writing.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <span>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/text_lines.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "hal/config/yaml_document.hpp"

namespace cairn::recording {
namespace {

constexpr std::size_t kMaxText = 200, kMaxNotes = 16'384;
constexpr double kMaxPose = 1e4;

const char* id_fault(std::string_view id) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  if (id.empty() || id.size() > 64) return "must have 1 … 64 characters";
  if (id.find_first_not_of(kAllowed) != std::string_view::npos)
    return "only letters, digits, `_`, `-` and `.` are allowed";
  return id.front() == '.' ? "must not start with a dot" : nullptr;
}

const char* text_fault(std::string_view text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (text.size() > kMaxText) return "is longer than 200 bytes";
  return std::any_of(text.begin(), text.end(), is_control) ? "holds control characters" : nullptr;
}

const char* notes_fault(std::string_view text) {
  const auto is_odd = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t'; };
  if (text.size() > kMaxNotes) return "is longer than 16384 bytes";
  return std::any_of(text.begin(), text.end(), is_odd) ? "holds control characters" : nullptr;
}

using TextCheck = const char* (*)(std::string_view);

/// Walks the document and collects faults; what is right is set at once, and dropped by the caller if anything is not.
class Checker {
 public:
  Checker(std::string_view file, const FileCheck& check_file) : file_(file), check_file_(check_file) {}

  void recording(const YAML::Node& node, Recording& r);
  void fault(const YAML::Node& node, const std::string& key, const std::string& cause) {
    fault_at(node.Mark().line, key, cause);
  }
  void fault_at(int line, const std::string& key, const std::string& cause) {
    faults_ += "\n" + std::string(file_) + ":" + std::to_string(std::max(line, 0) + 1) + ": " + key + ": " + cause;
  }
  [[nodiscard]] const std::string& faults() const { return faults_; }

 private:
  using Setter = std::function<void(const YAML::Node&, const std::string&)>;
  struct Key {
    std::string_view name;
    bool required;
    Setter set;
  };

  void mapping(const YAML::Node& node, const std::string& prefix, std::span<const Key> keys);
  Setter text(std::string& target, TextCheck check);
  Setter integer(std::int64_t min, std::int64_t max, std::function<void(std::int64_t)> set);
  Setter flag(bool& target);
  Setter utc(std::int64_t& target);
  Setter pose(std::optional<Vector6>& target);
  void sources(const YAML::Node& node, std::vector<SourceEntry>& list);
  void source(const YAML::Node& node, const std::string& prefix, SourceEntry& s);
  void unique(const YAML::Node& node, const std::vector<SourceEntry>& list);

  std::string_view file_;
  const FileCheck& check_file_;
  std::string faults_;
};

void Checker::mapping(const YAML::Node& node, const std::string& prefix, std::span<const Key> keys) {
  if (!node.IsMap()) return fault(node, prefix.empty() ? "file" : prefix, "must be a mapping of keys to values");
  const std::string dot = prefix.empty() ? "" : prefix + ".";
  std::vector<std::string> seen;
  for (const auto& entry : node) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    const auto key = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == name; });
    if (key == keys.end())
      fault(entry.first, dot + name.substr(0, 64), "unknown key");
    else if (std::find(seen.begin(), seen.end(), name) != seen.end())
      fault(entry.first, dot + name, "this key appears twice");
    else
      key->set(entry.second, dot + name);
    if (seen.size() <= keys.size()) seen.push_back(name);
  }
  for (const Key& key : keys)
    if (key.required && std::find(seen.begin(), seen.end(), key.name) == seen.end())
      fault(node, dot + std::string(key.name), "is missing");
}

Checker::Setter Checker::text(std::string& target, TextCheck check) {
  return [this, &target, check](const YAML::Node& node, const std::string& key) {
    if (!node.IsScalar()) return fault(node, key, "must be text");
    if (const char* cause = check(node.Scalar()); cause != nullptr) return fault(node, key, cause);
    target = node.Scalar();
  };
}

Checker::Setter Checker::integer(std::int64_t min, std::int64_t max, std::function<void(std::int64_t)> set) {
  return [this, min, max, set = std::move(set)](const YAML::Node& node, const std::string& key) {
    const auto value = node.IsScalar() ? parse_integer(node.Scalar()) : std::nullopt;
    if (value && *value >= min && *value <= max) return set(*value);
    fault(node, key, "must be a whole number " + std::to_string(min) + " … " + std::to_string(max));
  };
}

Checker::Setter Checker::flag(bool& target) {
  return [this, &target](const YAML::Node& node, const std::string& key) {
    const std::string value = node.IsScalar() ? node.Scalar() : "";
    if (value != "true" && value != "false") return fault(node, key, "must be true or false");
    target = value == "true";
  };
}

Checker::Setter Checker::utc(std::int64_t& target) {
  return [this, &target](const YAML::Node& node, const std::string& key) {
    const auto ns = node.IsScalar() ? parse_iso_utc(node.Scalar()) : std::nullopt;
    if (!ns || *ns > kMaxUtcNs)
      return fault(node, key, "must be a time such as 2026-01-31T12:00:00.000000000Z, 1970 … 2042");
    target = *ns;
  };
}

Checker::Setter Checker::pose(std::optional<Vector6>& target) {
  return [this, &target](const YAML::Node& node, const std::string& key) {
    const std::string wanted = "must be [x, y, z, roll, pitch, yaw] in metres and radians";
    if (!node.IsSequence() || node.size() != 6) return fault(node, key, wanted);
    Vector6 pose = Vector6::Zero();
    Eigen::Index i = 0;
    for (const auto& item : node) {
      const auto value = item.IsScalar() ? parse_number(item.Scalar()) : std::nullopt;
      if (!value || std::abs(*value) > kMaxPose) return fault(item, key, wanted);
      pose[i++] = *value;
    }
    target = pose;
  };
}

void Checker::source(const YAML::Node& node, const std::string& prefix, SourceEntry& s) {
  const auto port = [this](std::uint16_t& target) {
    return integer(1, 65'535, [&target](std::int64_t v) { target = static_cast<std::uint16_t>(v); });
  };
  const Setter kind = [&](const YAML::Node& n, const std::string& key) {
    const auto known = parse_sensor_kind(n.IsScalar() ? n.Scalar() : "");
    if (!known) return fault(n, key, "must be " + list_of_sensor_kinds());
    s.kind = *known;
  };
  const Setter file = [&](const YAML::Node& n, const std::string& key) {
    text(s.file, path_fault)(n, key);
    const auto unusable = s.file.empty() || !check_file_ ? std::nullopt : check_file_(s.file);
    if (unusable) fault(n, key, to_string(*unusable));
  };
  const std::array keys{Key{"id", true, text(s.id, id_fault)},
                        Key{"kind", true, kind},
                        Key{"file", true, file},
                        Key{"frame", true, text(s.frame, text_fault)},
                        Key{"model", false, text(s.model, text_fault)},
                        Key{"T_base_sensor", false, pose(s.base_sensor_xyz_rpy)},
                        Key{"data_port", false, port(s.data_port)},
                        Key{"position_port", false, port(s.position_port)},
                        Key{"deskewed", false, flag(s.deskewed)}};
  mapping(node, prefix, keys);
}

void Checker::unique(const YAML::Node& node, const std::vector<SourceEntry>& list) {
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const std::string prefix = "sources[" + std::to_string(i) + "].";
      if (!list[i].id.empty() && list[i].id == list[j].id)
        fault(node[i], prefix + "id", "is taken by an earlier source");
      if (!list[i].file.empty() && list[i].file == list[j].file)
        fault(node[i], prefix + "file", "belongs to an earlier source");
    }
}

void Checker::sources(const YAML::Node& node, std::vector<SourceEntry>& list) {
  if (!node.IsSequence() || node.size() == 0 || node.size() > kMaxSources)
    return fault(node, "sources", "must be a list of 1 … " + std::to_string(kMaxSources) + " sources");
  for (const auto& item : node) {
    const std::string prefix = "sources[" + std::to_string(list.size()) + "]";
    source(item, prefix, list.emplace_back());
  }
  unique(node, list);
}

void Checker::recording(const YAML::Node& node, Recording& r) {
  const std::array keys{
      Key{"robot", true, text(r.robot, id_fault)},
      Key{"profile", false, text(r.profile, text_fault)},
      Key{"start_utc", true, utc(r.start_utc_ns)},
      Key{"realtime_offset_ns", true,
          integer(-kMaxUtcNs, kMaxUtcNs, [&](std::int64_t v) { r.realtime_offset_ns = v; })},
      Key{"time_shift_ns", false, integer(-kMaxUtcNs, kMaxUtcNs, [&](std::int64_t v) { r.time_shift_ns = v; })},
      Key{"notes", false, text(r.notes, notes_fault)},
      Key{"unfinished", false, flag(r.unfinished)},
      Key{"sources", true, [&](const YAML::Node& n, const std::string&) { sources(n, r.sources); }}};
  mapping(node, "", keys);
}

std::string quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

std::string pose_text(const Vector6& pose) {
  std::string out = "[";
  for (const double v : pose) {
    char buffer[40];
    out += out.size() == 1 ? "" : ", ";
    out.append(std::begin(buffer), std::to_chars(std::begin(buffer), std::end(buffer), v).ptr);
  }
  return out + "]";
}

std::string source_text(const SourceEntry& s) {
  std::string out = "  - id: " + quoted(s.id) + "\n    kind: " + quoted(std::string(to_string(s.kind))) +
                    "\n    file: " + quoted(s.file) + "\n    frame: " + quoted(s.frame) +
                    "\n    model: " + quoted(s.model) + "\n";
  if (s.base_sensor_xyz_rpy)
    out += "    T_base_sensor: " + pose_text(*s.base_sensor_xyz_rpy) + "  # x y z [m] roll pitch yaw [rad]\n";
  if (s.kind == kVelodyne)
    out += "    data_port: " + std::to_string(s.data_port) + "\n    position_port: " + std::to_string(s.position_port) +
           "\n";
  if (s.kind == kScans) out += std::string("    deskewed: ") + (s.deskewed ? "true" : "false") + "\n";
  return out;
}

}  // namespace

Result<Recording> parse_recording(std::string_view yaml, std::string_view name, const FileCheck& check_file) {
  Recording recording;
  Checker checker(name, check_file);
  try {
    checker.recording(parse_yaml_document(yaml), recording);
  } catch (const YAML::Exception& e) {
    checker.fault_at(e.mark.line, "syntax", e.msg);
  }
  if (!checker.faults().empty())
    return Error{Errc::kMalformed, "invalid index of a recording", std::string(name), {}, checker.faults()};
  return recording;
}

std::string to_yaml(const Recording& r) {
  std::string out =
      "# A recording of Cairn: native files and what they hold. Stamps in pcap files are UTC;\n"
      "# the robot's monotonic time is UTC - realtime_offset_ns.\n";
  out += "robot: " + quoted(r.robot) + "\nprofile: " + quoted(r.profile) +
         "\nstart_utc: " + to_iso_utc(r.start_utc_ns) +
         "\nrealtime_offset_ns: " + std::to_string(r.realtime_offset_ns) +
         (r.time_shift_ns != 0 ? "\ntime_shift_ns: " + std::to_string(r.time_shift_ns) : "") +
         "\nnotes: " + quoted(r.notes) + (r.unfinished ? "\nunfinished: true" : "") + "\nsources:\n";
  for (const SourceEntry& s : r.sources) out += source_text(s);
  return out;
}

}  // namespace cairn::recording
