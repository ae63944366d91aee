// SPDX-License-Identifier: Apache-2.0
#include "hal/config/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>

#include "hal/config/yaml_document.hpp"
#include "hal/files/file.hpp"

namespace cairn::config {
namespace {

constexpr std::uint64_t kMaxFileBytes = 1U << 20U;

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

std::string shortest(double v) {
  char buffer[32];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), v).ptr;
  return {std::begin(buffer), end};
}

template <class T>
std::optional<T> number_in(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* last = text.data() + text.size();
  T value{};
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
}

constexpr const char* kNoTabs = "; indent with spaces, not tabs";

/// Whether the line of this number, from 0, holds a tab.
bool has_tab(std::string_view text, int line) {
  for (; line > 0 && !text.empty(); --line) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n')).find('\t') != std::string_view::npos;
}

/// Walks a parsed document along a declaration, collecting faults and, apart from them, what to set.
class Checker {
 public:
  Checker(std::string_view file) : file_(file) {}

  void section(const YAML::Node& node, Section& section, const std::string& prefix) {
    if (node.IsNull()) return;
    if (!node.IsMap()) return fault(node, prefix, "must be a mapping of keys to values");
    std::vector<std::string> seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) {
        fault(entry.first, prefix, "a key must be plain text");
        continue;
      }
      const std::string& key = entry.first.Scalar();
      const std::string path = prefix.empty() ? key : prefix + "." + key;
      const auto is_key = [&](const Field& f) { return f.key == key; };
      const auto field = std::find_if(section.fields().begin(), section.fields().end(), is_key);
      if (field == section.fields().end())
        fault(entry.first, path, "unknown key; known here: " + known(section));
      else if (std::find(seen.begin(), seen.end(), key) != seen.end())
        fault(entry.first, path, "this key appears twice");
      else
        value(entry.second, *field, path);
      seen.push_back(key);
    }
  }

  void fault(const YAML::Node& node, const std::string& path, const std::string& cause) {
    fault_at(node.Mark().line, path, cause);
  }
  void fault_at(int line, const std::string& path, const std::string& cause) {
    if (!faults_.empty()) faults_ += '\n';
    faults_ += std::string(file_) + ":" + std::to_string(line + 1) + ": " + path + ": " + cause;
  }

  Result<void> finish() {
    if (!faults_.empty())
      return Error{Errc::kInvalidConfig, "invalid configuration", std::string(file_), {}, "\n" + faults_};
    for (const auto& set : setters_) set();
    return {};
  }

 private:
  static std::string known(const Section& section) {
    std::string list;
    for (const Field& f : section.fields()) list += (list.empty() ? "" : ", ") + f.key;
    return list;
  }

  static std::string bounds(const Field& f) {
    return shortest(f.range.min) + " … " + shortest(f.range.max) + (f.unit.empty() ? "" : " " + f.unit);
  }

  /// Angles are often meant in degrees.
  static const char* hint(const Field& f) {
    return f.unit == "rad" || f.unit == "m, rad" ? "; angles are in radians: 90 degrees are 1.5708" : "";
  }

  template <class T>
  std::optional<T> in_range(const YAML::Node& node, const Field& f, const std::string& path) {
    const std::optional<T> v = node.IsScalar() ? number_in<T>(node) : std::nullopt;
    if (!v || !std::isfinite(static_cast<double>(*v)))
      fault(node, path, std::is_integral_v<T> ? "must be a whole number" : "must be a number");
    else if (static_cast<double>(*v) < f.range.min || static_cast<double>(*v) > f.range.max)
      fault(node, path, shortest(static_cast<double>(*v)) + " is out of range " + bounds(f) + hint(f));
    else
      return v;
    return std::nullopt;
  }

  template <class T>
  void scalar(const YAML::Node& node, const Field& f, T* target, const std::string& path) {
    if (const auto v = in_range<T>(node, f, path)) setters_.emplace_back([target, v] { *target = *v; });
  }

  void list(const YAML::Node& node, const Field& f, std::vector<double>* target, const std::string& path) {
    if (!node.IsSequence() || node.size() != target->size())
      return fault(node, path, "must be a list of " + std::to_string(target->size()) + " numbers");
    std::vector<double> values;
    for (const auto& item : node)
      if (const auto v = in_range<double>(item, f, path)) values.push_back(*v);
    setters_.emplace_back([target, values] { *target = values; });
  }

  void flag(const YAML::Node& node, bool* target, const std::string& path) {
    const bool yes = node.IsScalar() && node.Scalar() == "true";
    if (!yes && !(node.IsScalar() && node.Scalar() == "false")) return fault(node, path, "must be true or false");
    setters_.emplace_back([target, yes] { *target = yes; });
  }

  void choice(const YAML::Node& node, const Field::Choice& c, const std::string& path) {
    const auto& [target, options] = c;
    const std::string text = node.IsScalar() ? node.Scalar() : "";
    if (std::find(options.begin(), options.end(), text) != options.end()) {
      setters_.emplace_back([target = target, text] { *target = text; });
      return;
    }
    std::string all;
    for (const std::string& o : options) all += (all.empty() ? "" : ", ") + o;
    fault(node, path, "must be one of " + all);
  }

  void value(const YAML::Node& node, const Field& f, const std::string& path) {
    std::visit(Overloaded{
                   [&](bool* t) { flag(node, t, path); },
                   [&](int* t) { scalar(node, f, t, path); },
                   [&](double* t) { scalar(node, f, t, path); },
                   [&](std::string* t) {
                     if (!node.IsScalar()) return fault(node, path, "must be text");
                     setters_.emplace_back([t, s = node.Scalar()] { *t = s; });
                   },
                   [&](const Field::Choice& c) { choice(node, c, path); },
                   [&](std::vector<double>* t) { list(node, f, t, path); },
                   [&](const std::unique_ptr<Section>& s) { section(node, *s, path); },
               },
               f.target);
  }

  std::string_view file_;
  std::string faults_;
  std::vector<std::function<void()>> setters_;
};

std::string quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

std::string value_text(const Field& f) {
  return std::visit(Overloaded{
                        [](const bool* v) -> std::string { return *v ? "true" : "false"; },
                        [](const int* v) { return std::to_string(*v); },
                        [](const double* v) { return shortest(*v); },
                        [](const std::string* v) { return quoted(*v); },
                        [](const Field::Choice& c) { return *c.first; },
                        [](const std::vector<double>* v) {
                          std::string all;
                          for (const double d : *v) all += (all.empty() ? "" : ", ") + shortest(d);
                          return "[" + all + "]";
                        },
                        [](const std::unique_ptr<Section>&) { return std::string(); },
                    },
                    f.target);
}

void write(std::ostream& out, const Section& section, const std::string& indent) {
  for (const Field& f : section.fields()) {
    out << indent << f.key << ':';
    if (const std::string value = value_text(f); !value.empty()) out << ' ' << value;
    out << "  # " << (f.unit.empty() ? "" : "[" + f.unit + "] ") << f.doc << '\n';
    if (const auto* nested = std::get_if<std::unique_ptr<Section>>(&f.target)) write(out, **nested, indent + "  ");
  }
}

}  // namespace

void Section::flag(std::string key, bool& value, std::string doc) {
  fields_.push_back({std::move(key), &value, {}, "", std::move(doc)});
}
void Section::integer(std::string key, int& value, Range range, std::string unit, std::string doc) {
  fields_.push_back({std::move(key), &value, range, std::move(unit), std::move(doc)});
}
void Section::number(std::string key, double& value, Range range, std::string unit, std::string doc) {
  fields_.push_back({std::move(key), &value, range, std::move(unit), std::move(doc)});
}
void Section::text(std::string key, std::string& value, std::string doc) {
  fields_.push_back({std::move(key), &value, {}, "", std::move(doc)});
}
void Section::choice(std::string key, std::string& value, std::vector<std::string> options, std::string doc) {
  fields_.push_back({std::move(key), Field::Choice{&value, std::move(options)}, {}, "", std::move(doc)});
}
void Section::numbers(std::string key, std::vector<double>& value, Range range, std::string unit, std::string doc) {
  fields_.push_back({std::move(key), &value, range, std::move(unit), std::move(doc)});
}
Section& Section::subsection(std::string key, std::string doc) {
  auto nested = std::make_unique<Section>();
  Section& reference = *nested;
  fields_.push_back({std::move(key), std::move(nested), {}, "", std::move(doc)});
  return reference;
}

Result<void> parse(std::string_view yaml, std::string_view file_name, Section& section) {
  Checker checker(file_name);
  try {
    checker.section(parse_yaml_document(yaml), section, "");
  } catch (const YAML::Exception& e) {
    checker.fault_at(e.mark.line, "syntax", e.msg + (has_tab(yaml, e.mark.line) ? kNoTabs : ""));
  }
  return checker.finish();
}

Result<void> load(const std::filesystem::path& path, Section& section) {
  const auto bytes = read_file(path, kMaxFileBytes);
  if (!bytes) return bytes.error();
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  return parse({text, bytes->size()}, path.string(), section);
}

std::string to_yaml(const Section& section) {
  std::ostringstream out;
  write(out, section, "");
  return out.str();
}

}  // namespace cairn::config
