// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/motor_bus.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/drive/chassis/differential.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kWheelStream = 70, kNodeStream = 71;
constexpr Duration kFrameTime = std::chrono::microseconds(222);  // a classic frame with 8 bytes at 500 kbit/s
constexpr Duration kSpin = std::chrono::milliseconds(250);
constexpr double kSpinShare = 0.8;  // how much faster the spinning side turns

/// What base_link does between two instants, per second: forward and turning left.
drive::Velocity velocity(const Trajectory& trajectory, Time from, Time to) {
  const SE3 moved = trajectory.T_world_base(from).inverse() * trajectory.T_world_base(to);
  const double dt = to_seconds(to - from);
  return {moved.translation().x() / dt, moved.xyz_rpy()[5] / dt};
}

}  // namespace

drive::Config husky_drive() {
  drive::Config c;
  c.wheel_radius_m = 0.165;
  c.wheel_separation_m = 0.67;  // effective: a Husky skids, as config/husky.yaml has it
  c.max_speed_m_s = 2.0;
  c.max_yaw_rate_rad_s = 2.0;
  c.velocity_units_per_rad_s = 1000;
  c.position_counts_per_rad = 12'000;
  c.vendor = 0x300;
  c.product = 0x4644;
  return c;
}

MotorBus::MotorBus(const WheelConfig& config, const Trajectory& trajectory, std::uint64_t seed)
    : config_(config),
      trajectory_(trajectory),
      random_(seed, kWheelStream),
      now_(trajectory.start() - kPowerOn),
      drive_config_(husky_drive()),
      wheels_(TrueWheels::draw(config, drive_config_, random_)) {
  next_spin_ = trajectory.start() + from_seconds(config.spin_every_s * random_.uniform(0.3, 1.7));
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
    DriveModelConfig node;
    node.node = id;
    node.velocity_units_per_rad_s = drive_config_.velocity_units_per_rad_s;
    node.position_counts_per_rad = drive_config_.position_counts_per_rad;
    node.encoder_noise_counts = config.encoder_noise_counts;
    node.seed = mix(seed ^ kNodeStream);
    nodes_.emplace_back(node);
  }
  drive_ = std::move(*drive::CanDrive::create(drive_config_, *this));
  for (DriveModel& node : nodes_) {
    DriveModel::Frames out;
    node.power_on(now_, out);
    for (const drive::CanFrame& frame : out) carry(frame, drive::Direction::kReceived);
  }
}

/// One frame at a time fits on the wire.
void MotorBus::carry(const drive::CanFrame& frame, drive::Direction direction) {
  free_ = std::max(free_, now_) + kFrameTime;
  Packet packet;
  packet.channel = static_cast<std::uint16_t>(direction);
  packet.sequence = sequence_++;
  packet.arrival = free_;
  drive::encode_frame(frame, packet);
  frames_.push_back(packet);
  inbox_.push_back(std::move(packet));
}

Result<Poll> MotorBus::next(Packet& packet, Duration) {
  if (inbox_.empty()) return Poll::kTimeout;
  packet = std::move(inbox_.front());
  inbox_.pop_front();
  return Poll::kPacket;
}

drive::SendResult MotorBus::send(const drive::CanFrame& frame) {
  carry(frame, drive::Direction::kSent);
  for (DriveModel& node : nodes_) {
    DriveModel::Frames out;
    node.receive(frame, now_, out);
    for (const drive::CanFrame& answer : out) carry(answer, drive::Direction::kReceived);
  }
  return drive::SendResult::kSent;
}

void MotorBus::turn_wheels() {
  const double dt = to_seconds(kTick);
  const drive::Velocity body = velocity(trajectory_, now_ - kTick, now_);
  const drive::WheelSpeeds rims = drive::wheel_speeds(body, wheels_.separation_m);
  if (now_ >= next_spin_ && std::abs(body.v) > 0.4) {
    spin_until_ = now_ + kSpin;
    spinning_ = random_.below(2);
    next_spin_ = now_ + from_seconds(config_.spin_every_s * random_.uniform(0.5, 1.5));
    ++spins_;
  }
  const auto [left_noise, right_noise] = random_.normal_pair();
  const double travel[2] = {rims.left * dt, rims.right * dt}, noise[2] = {left_noise, right_noise};
  for (std::size_t side = 0; side < 2; ++side) {
    const bool spins = now_ < spin_until_ && side == spinning_;
    const double slipped = travel[side] * (spins ? 1 + kSpinShare : 1.0) +
                           config_.travel_noise_m * std::sqrt(std::abs(travel[side])) * noise[side];
    angle_[side] += slipped / wheels_.radius_m[side];
    const double sign = side == 0 ? 1.0 : -1.0;  // the right motor is mounted the other way round
    nodes_[side].follow(sign * angle_[side], sign * slipped / wheels_.radius_m[side] / dt);
  }
}

void MotorBus::tick(bool armable) {
  frames_.clear();
  now_ += kTick;
  turn_wheels();
  for (DriveModel& node : nodes_) {
    DriveModel::Frames out;
    node.step(now_, out);
    for (const drive::CanFrame& frame : out) carry(frame, drive::Direction::kReceived);
  }
  if (!armable) {
    drive_->stop(DriveCause::kEmergencyStop, now_);
  } else if (drive_->status().level == DriveLevel::kStop) {
    if (const auto epoch = drive_->arm(now_)) epoch_ = *epoch;
  }
  const drive::Velocity wanted = velocity(trajectory_, now_, now_ + kTick);
  // Discarded while the drive is stopped: that is how it should be.
  (void)drive_->command({wanted.v, wanted.w, epoch_}, now_);
  (void)drive_->tick(now_);
}

}  // namespace cairn::simulator
