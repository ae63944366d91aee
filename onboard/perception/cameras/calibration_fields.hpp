// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::cameras {

/// What is wrong with a file, one line each.
class CalibrationFaults {
 public:
  explicit CalibrationFaults(std::string_view file) : file_(file) {}
  void add(const YAML::Node& node, const std::string& key, const std::string& cause) {
    add(node.IsDefined() ? node.Mark().line : 0, key, cause);
  }
  void add(int line, const std::string& key, const std::string& cause);
  /// The kind of camera or lens is none that is known. The error is then kUnsupported.
  void unsupported(const YAML::Node& node, const std::string& key, const std::string& cause);
  [[nodiscard]] bool none() const { return lines_.empty(); }
  [[nodiscard]] Error error() const;

 private:
  std::string file_, lines_;
  Errc code_ = Errc::kMalformed;
  int count_ = 0;
};

/// One mapping of a calibration file. Each getter reports what is wrong with its key. Must not outlive the faults.
class CalibrationFields {
 public:
  CalibrationFields(const YAML::Node& node, std::string prefix, CalibrationFaults& faults)
      : node_(node), prefix_(std::move(prefix)), faults_(&faults) {}

  [[nodiscard]] bool has(const std::string& key) const { return find(key).IsDefined(); }
  /// The first of these keys that is there; the first of all where none is.
  [[nodiscard]] std::string present(std::initializer_list<const char*> keys) const;
  [[nodiscard]] CalibrationFields section(const std::string& key) const { return {find(key), path(key), *faults_}; }

  /// Text; empty where the key is missing.
  [[nodiscard]] std::string text(const std::string& key) const;
  /// A whole number from 1 to `most`; 0 after a fault.
  [[nodiscard]] int positive(const std::string& key, int most) const;
  /// A list of numbers, also of lists of numbers, or the data of a matrix. Empty after a fault, or if the number of
  /// numbers is none of `counts`.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::initializer_list<std::size_t> counts) const;
  /// A rigid 4×4 transform, row by row.
  [[nodiscard]] std::optional<SE3> transform(const std::string& key) const;

  void fault(const std::string& key, const std::string& cause) const { faults_->add(find(key), path(key), cause); }
  void unsupported(const std::string& key, const std::string& cause) const {
    faults_->unsupported(find(key), path(key), cause);
  }

 private:
  [[nodiscard]] YAML::Node find(const std::string& key) const;
  [[nodiscard]] std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }
  struct Collected;
  bool collect(const YAML::Node& list, const std::string& key, Collected& all, int depth) const;

  YAML::Node node_;
  std::string prefix_;
  CalibrationFaults* faults_;
};

}  // namespace cairn::cameras
