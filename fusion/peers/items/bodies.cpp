// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/peers/items/wire.hpp"

namespace cairn::peers {
namespace {

constexpr std::int64_t kFarthestCm = 100'000'000, kFastestCm = 5'000, kWidestCm = 1'000;  // cm, cm/s, cm
constexpr std::int64_t kMostVariance = 10'000'000;                                        // cm²: 30 m, 1 σ
constexpr std::int64_t kLifeMs = Bodies::kLife / std::chrono::milliseconds(1);
constexpr std::int64_t kLongestClockNs = std::int64_t{1} << 60U;  // 36 years, as of a hello

std::int64_t bounded(double value, double parts, std::int64_t least, std::int64_t most) {
  if (!std::isfinite(value)) return std::clamp<std::int64_t>(0, least, most);
  const double scaled = std::clamp(value * parts, static_cast<double>(least), static_cast<double>(most));
  return std::clamp<std::int64_t>(std::llround(scaled), least, most);
}

void append_whole(std::vector<std::byte>& out, std::int64_t value) { append_varint(out, zigzag(value)); }

void append_place(std::vector<std::byte>& out, const Eigen::Vector3d& position, const Eigen::Vector2d& velocity) {
  for (const double p : {position.x(), position.y(), position.z()})
    append_whole(out, bounded(p, 100, -kFarthestCm, kFarthestCm));
  for (const double v : {velocity.x(), velocity.y()}) append_whole(out, bounded(v, 100, -kFastestCm, kFastestCm));
}

/// The covariance stays positive definite though it is rounded.
void append_covariance(std::vector<std::byte>& out, const Eigen::Matrix2d& c) {
  const std::int64_t xx = bounded(c(0, 0), 1e4, 1, kMostVariance), yy = bounded(c(1, 1), 1e4, 1, kMostVariance);
  const auto most = static_cast<std::int64_t>(std::sqrt(static_cast<double>(xx * yy - 1)));
  append_whole(out, xx);
  append_whole(out, bounded(c(0, 1), 1e4, -most, most));
  append_whole(out, yy);
}

/// Reads whole numbers within bounds; remembers that one was wrong.
class Whole {
 public:
  explicit Whole(ByteReader& in) : in_(in) {}
  std::int64_t read(std::int64_t least, std::int64_t most) {
    const auto read = sound_ ? read_varint(in_) : std::nullopt;
    const std::int64_t value = read ? unzigzag(*read) : 0;
    sound_ = read && value >= least && value <= most;
    return sound_ ? value : std::clamp<std::int64_t>(0, least, most);
  }
  std::uint64_t read_count(std::uint64_t least, std::uint64_t most) {
    const auto read = sound_ ? read_varint(in_) : std::nullopt;
    sound_ = read && *read >= least && *read <= most;
    return sound_ ? *read : least;
  }
  double centi(std::int64_t least, std::int64_t most) { return 0.01 * static_cast<double>(read(least, most)); }
  void refuse_unless(bool holds) { sound_ = sound_ && holds; }
  [[nodiscard]] bool sound() const { return sound_; }

 private:
  ByteReader& in_;
  bool sound_ = true;
};

void read_place(Whole& in, Eigen::Vector3d& position, Eigen::Vector2d& velocity) {
  for (double& p : position) p = in.centi(-kFarthestCm, kFarthestCm);
  for (double& v : velocity) v = in.centi(-kFastestCm, kFastestCm);
}

Eigen::Matrix2d read_covariance(Whole& in) {
  const std::int64_t xx = in.read(1, kMostVariance), xy = in.read(-kMostVariance, kMostVariance);
  const std::int64_t yy = in.read(1, kMostVariance);
  in.refuse_unless(xy * xy < xx * yy);
  const std::array c{1e-4 * static_cast<double>(xx), 1e-4 * static_cast<double>(xy), 1e-4 * static_cast<double>(yy)};
  Eigen::Matrix2d covariance;
  covariance << c[0], c[1], c[1], c[2];
  return covariance;
}

Bodies::Person read_person(Whole& in, std::uint64_t above) {
  Bodies::Person person;
  person.id = static_cast<std::uint32_t>(above + in.read_count(1, ~std::uint32_t{0} - above));
  read_place(in, person.position_m, person.velocity_m_s);
  person.covariance = read_covariance(in);
  return person;
}

}  // namespace

void append_bodies(std::vector<std::byte>& out, const Bodies& bodies) {
  append_varint(out, bodies.epoch);
  append_le(out, static_cast<std::int64_t>(bodies.stamp.time_since_epoch().count()));
  append_varint(
      out, static_cast<std::uint64_t>(std::clamp<std::int64_t>(bodies.age / std::chrono::milliseconds(1), 0, kLifeMs)));
  append_place(out, bodies.robot.position_m, bodies.robot.velocity_m_s);
  append_whole(out, bounded(bodies.robot.radius_m, 100, 0, kWidestCm));
  append_whole(out, bounded(bodies.robot.height_m, 100, 0, kWidestCm));
  std::size_t count = 0;
  std::uint32_t above = 0;
  const auto fits = [&](const Bodies::Person& p) { return p.id > above && count < Bodies::kMost; };
  std::vector<std::byte> people;
  for (const Bodies::Person& person : bodies.people) {
    if (!fits(person)) continue;
    append_varint(people, person.id - above);
    append_place(people, person.position_m, person.velocity_m_s);
    append_covariance(people, person.covariance);
    above = person.id;
    ++count;
  }
  append_varint(out, count);
  out.insert(out.end(), people.begin(), people.end());
}

Result<Bodies> read_bodies(ByteReader& in) {
  Bodies bodies;
  Whole whole(in);
  bodies.epoch = whole.read_count(0, kLastEpoch);
  const auto stamp = whole.sound() ? in.read<std::int64_t>() : std::nullopt;
  whole.refuse_unless(stamp && *stamp > -kLongestClockNs && *stamp < kLongestClockNs);
  bodies.stamp = Time{Duration{stamp.value_or(0)}};
  bodies.age = std::chrono::milliseconds(whole.read_count(0, static_cast<std::uint64_t>(kLifeMs)));
  read_place(whole, bodies.robot.position_m, bodies.robot.velocity_m_s);
  bodies.robot.radius_m = whole.centi(0, kWidestCm);
  bodies.robot.height_m = whole.centi(0, kWidestCm);
  const std::uint64_t count = whole.read_count(0, Bodies::kMost);
  std::uint64_t above = 0;
  for (std::uint64_t i = 0; i < count && whole.sound(); ++i) {
    bodies.people.push_back(read_person(whole, above));
    above = bodies.people.back().id;
  }
  if (whole.sound()) return bodies;
  return Error{Errc::kMalformed, "people or a robot that cannot be", {}, in.offset()};
}

}  // namespace cairn::peers
