// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/calibration_fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace cairn::cameras {
namespace {

constexpr std::size_t kMostNumbers = 64;  // and lists in a list; no calibration has more
constexpr int kMostFaults = 20;           // a person reads no more
constexpr double kRotationTolerance = 1e-3;

std::optional<double> number_in(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  const std::string& text = node.Scalar();
  const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* last = text.data() + text.size();
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc{} || end != last || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

void CalibrationFaults::add(int line, const std::string& key, const std::string& cause) {
  if (++count_ > kMostFaults) return;
  lines_ += "\n" + file_ + ":" + std::to_string(line + 1) + ": " + key + ": " + cause;
}

void CalibrationFaults::unsupported(const YAML::Node& node, const std::string& key, const std::string& cause) {
  code_ = Errc::kUnsupported;
  add(node, key, cause);
}

Error CalibrationFaults::error() const {
  const std::string more = count_ > kMostFaults ? "\nand " + std::to_string(count_ - kMostFaults) + " more" : "";
  return {code_, "faults in the calibration", file_, {}, lines_ + more};
}

YAML::Node CalibrationFields::find(const std::string& key) const {
  YAML::Node found(YAML::NodeType::Undefined);
  if (!node_.IsDefined() || !node_.IsMap()) return found;
  bool twice = false;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
    twice = found.IsDefined();
    if (!twice) found.reset(entry.second);
  }
  if (twice) faults_->add(found, path(key), "this key appears twice");
  return found;
}

std::string CalibrationFields::present(std::initializer_list<const char*> keys) const {
  for (const char* key : keys)
    if (has(key)) return key;
  return *keys.begin();
}

std::string CalibrationFields::text(const std::string& key) const {
  const YAML::Node node = find(key);
  return node.IsDefined() && node.IsScalar() ? node.Scalar() : "";
}

int CalibrationFields::positive(const std::string& key, int most) const {
  const auto value = numbers(key, {1});
  if (value.empty()) return 0;
  if (value[0] >= 1 && value[0] <= most && value[0] == std::floor(value[0])) return static_cast<int>(value[0]);
  fault(key, "must be a whole number from 1 to " + std::to_string(most));
  return 0;
}

/// Numbers found so far. Lists count too: aliases make few bytes into very many empty lists.
struct CalibrationFields::Collected {
  std::vector<double> values;
  std::size_t visited = 0;
};

bool CalibrationFields::collect(const YAML::Node& list, const std::string& key, Collected& all, int depth) const {
  if (!list.IsSequence()) {
    const auto value = number_in(list);
    if (value) all.values.push_back(*value);
    if (!value) faults_->add(list, path(key), "must be a number");
    return value.has_value();
  }
  for (const auto& item : list) {
    if (depth == 0 || ++all.visited > kMostNumbers) {
      faults_->add(list, path(key), "must be a list of numbers, or of rows of numbers");
      return false;
    }
    if (!collect(item, key, all, depth - 1)) return false;
  }
  return true;
}

std::vector<double> CalibrationFields::numbers(const std::string& key,
                                               std::initializer_list<std::size_t> counts) const {
  YAML::Node node = find(key);
  if (!node.IsDefined()) {
    fault(key, "is missing");
    return {};
  }
  if (node.IsMap()) node.reset(CalibrationFields(node, path(key), *faults_).find("data"));
  if (!node.IsDefined()) {
    fault(key, "has no data");
    return {};
  }
  Collected found;
  if (!collect(node, key, found, 2)) return {};
  const std::size_t n = found.values.size();
  if (std::find(counts.begin(), counts.end(), n) != counts.end()) return std::move(found.values);
  std::string wanted;
  for (const std::size_t count : counts) wanted += (wanted.empty() ? "" : " or ") + std::to_string(count);
  fault(key, "must have " + wanted + " numbers, has " + std::to_string(n));
  return {};
}

std::optional<SE3> CalibrationFields::transform(const std::string& key) const {
  const auto values = numbers(key, {16});
  if (values.empty()) return std::nullopt;
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= kRotationTolerance)) {
    fault(key, "its 3x3 part is scaled or skewed, not a rotation");
  } else if (R.determinant() < 0) {
    fault(key, "its 3x3 part is mirrored (determinant -1), not a rotation");
  } else if (!((T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() <= kRotationTolerance)) {
    fault(key, "its last row must be 0 0 0 1");
  } else {
    return SE3(R, Eigen::Vector3d(T.topRightCorner<3, 1>()));
  }
  return std::nullopt;
}

}  // namespace cairn::cameras
