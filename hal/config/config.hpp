// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/result.hpp"

namespace cairn::config {

/// The values that a number may have.
struct Range {
  double min, max;  ///< both inclusive
};

class Section;

/// One key: where its value is and what it may be.
struct Field {
  using Choice = std::pair<std::string*, std::vector<std::string>>;
  std::string key;
  std::variant<bool*, int*, double*, std::string*, Choice, std::vector<double>*, std::unique_ptr<Section>> target;
  Range range{};
  std::string unit;
  std::string doc;
};

/// The declaration of a config struct: one call per member. A module writes beside its struct
///
///     inline void declare(config::Section& s, OdometryConfig& c) {
///       s.number("voxel_size_m", c.voxel_size_m, {0.05, 5.0}, "m", "edge of a map voxel");
///     }
///
/// and the same declaration reads a file, checks it and writes the effective values. The struct must outlive it.
class Section {
 public:
  /// One key and the member that holds its value and its default. `unit` and `doc` become comments in to_yaml().
  /// `doc` says what the value means.
  void flag(std::string key, bool& value, std::string doc);
  /// The same for a whole number.
  void integer(std::string key, int& value, Range range, std::string unit, std::string doc);
  /// The same for a real number.
  void number(std::string key, double& value, Range range, std::string unit, std::string doc);
  /// The same for a text.
  void text(std::string key, std::string& value, std::string doc);
  /// The same for a text that must be one of `options`.
  void choice(std::string key, std::string& value, std::vector<std::string> options, std::string doc);
  /// A list of exactly as many numbers as `value` holds now.
  void numbers(std::string key, std::vector<double>& value, Range range, std::string unit, std::string doc);
  /// A nested mapping, declared by declare(Section&, T&).
  template <class T>
  void group(std::string key, T& value, std::string doc) {
    declare(subsection(std::move(key), std::move(doc)), value);
  }

  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }

 private:
  Section& subsection(std::string key, std::string doc);
  std::vector<Field> fields_;
};

/// Sets the declared values from YAML text. Keys left out keep their defaults. Unknown and repeated keys, wrong types
/// and values out of range are all reported in one Error (Errc::kInvalidConfig), one line each in `detail`:
/// "file:line: key: cause". On an error nothing is set.
Result<void> parse(std::string_view yaml, std::string_view file_name, Section& section);
/// The same from a file. Further errors: kNotFound, kIo, and kLimit for a file above 1 MiB.
Result<void> load(const std::filesystem::path& path, Section& section);

/// All values as YAML, with unit and documentation as comments: parse(to_yaml(s)) restores them exactly.
[[nodiscard]] std::string to_yaml(const Section& section);

}  // namespace cairn::config
