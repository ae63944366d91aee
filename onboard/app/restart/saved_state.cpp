// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_state.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace cairn::app {
namespace {

constexpr std::size_t kMaxBoot = 64;

template <class T>
void append_number(std::string& out, T value) {
  std::array<char, 40> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(" ").append(text.data(), error == std::errc{} ? end : text.data());
}

void append_line(std::string& out, std::string_view name, std::span<const double> values) {
  out.append("\n").append(name);
  for (const double v : values) append_number(out, v);
}

/// Takes the text apart from front to back; the first thing that is not as it should be is remembered.
class StateReader {
 public:
  explicit StateReader(std::string_view text) : rest_(text) {}

  void line(std::string_view name) {
    if (!line_.empty()) expect("\n");
    if (!failed_) line_ = name;
    expect(name);
  }
  template <class T>
  T number() {
    expect(" ");
    T value{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) return fail(), T{};
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) fail();
    return value;
  }
  std::string word() {
    expect(" ");
    const std::string_view word = rest_.substr(0, rest_.find('\n'));
    const auto plain = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
    };
    if (word.size() > kMaxBoot || !std::all_of(word.begin(), word.end(), plain)) return fail(), std::string();
    rest_.remove_prefix(word.size());
    return std::string(word);
  }
  template <class Matrix>
  void numbers(std::string_view name, Matrix& out) {
    line(name);
    for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = number<double>();
  }
  void end() { expect("\n"), failed_ = failed_ || !rest_.empty(); }
  void fail() { failed_ = true; }
  [[nodiscard]] std::optional<Error> error() const {
    if (!failed_) return std::nullopt;
    return Error{Errc::kMalformed, "the saved state is damaged", {}, {}, "line " + std::string(line_)};
  }

 private:
  void expect(std::string_view text) {
    failed_ = failed_ || !rest_.starts_with(text);
    if (failed_)
      rest_ = {};
    else
      rest_.remove_prefix(text.size());
  }
  std::string_view rest_, line_;
  bool failed_ = false;
};

}  // namespace

std::string to_text(const SavedState& s) {
  std::string out = "cairn-state 1\nsequence";
  append_number(out, s.sequence);
  out += "\nepoch";
  append_number(out, s.epoch);
  out += "\nboot " + s.boot.substr(0, kMaxBoot) + "\nstamp_ns";
  append_number(out, s.stamp.time_since_epoch().count());
  const auto& t = s.T_odom_base.mean.translation();
  const auto& q = s.T_odom_base.mean.quaternion();
  append_line(out, "pose", std::array{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
  append_line(out, "twist", {s.twist.data(), 6});
  append_line(out, "covariance", {s.T_odom_base.covariance.data(), 36});  // symmetric: rows are columns
  return out + "\n";
}

Result<SavedState> parse_state(std::string_view text) {
  SavedState s;
  StateReader in(text);
  in.line("cairn-state 1");
  in.line("sequence");
  s.sequence = in.number<std::uint64_t>();
  in.line("epoch");
  s.epoch = in.number<std::uint32_t>();
  in.line("boot");
  s.boot = in.word();
  in.line("stamp_ns");
  s.stamp = Time{Duration{in.number<std::int64_t>()}};
  Eigen::Matrix<double, 7, 1> pose = Eigen::Matrix<double, 7, 1>::Zero();
  in.numbers("pose", pose);
  in.numbers("twist", s.twist);
  in.numbers("covariance", s.T_odom_base.covariance);
  in.end();
  const Eigen::Quaterniond q(pose[6], pose[3], pose[4], pose[5]);
  if (std::abs(q.norm() - 1) > 1e-6) in.fail();
  if (auto error = in.error()) return std::move(*error);
  s.T_odom_base.mean = SE3(q, pose.head<3>());
  return s;
}

}  // namespace cairn::app
