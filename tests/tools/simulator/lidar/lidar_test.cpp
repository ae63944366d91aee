// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/lidar.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

constexpr Time kStart = Time(std::chrono::seconds(10));
constexpr std::int64_t kStartUtcNs = 1'780'293'600'000'000'000;  // 2026-06-01T06:00:00Z
const Vector3d kLow(-6, -4, 0), kHigh(6, 4, 3);

const velodyne::Model& vlp16() { return *velodyne::find_model("VLP-16"); }

Tracer box_room(Material material = Material::kPlaster) {
  Mesh mesh;
  mesh.box({0, 0, 0, 0}, 12, 8, 3, material);
  return std::move(*Tracer::build(mesh));
}

Trajectory at_rest() { return {kStart, {(Vector6() << 1.0, 0.5, 0.2, 0.02, -0.03, 0.4).finished()}}; }

/// 1.5 m radius at 1.5 m/s.
Trajectory on_circle() {
  std::vector<Vector6> knots;
  for (int i = 0; i < 200; ++i) {
    const double a = 0.01 * i;
    knots.push_back((Vector6() << 1.5 * std::sin(a), 1.5 - 1.5 * std::cos(a), 0.2, 0.0, 0.0, a).finished());
  }
  return {kStart, knots};
}

LidarConfig perfect(double half_range_m = 1e4) {
  LidarConfig config;
  config.range_noise_m = 0;
  config.dropout = 0;
  config.intensity_noise = 0;
  config.half_range_m = half_range_m;
  return config;
}

Packet data_packet(const Lidar& lidar, std::uint64_t n) {
  Lidar::DataPacket bytes;
  (void)lidar.fill(n, bytes);
  Packet packet;
  packet.channel = velodyne::kDefaultDataPort;
  packet.arrival = lidar.arrival(n);
  packet.bytes.assign(bytes.begin(), bytes.end());
  return packet;
}

/// Hands every scan of `packets` packets to `use`.
template <class Use>
void decode(const Lidar& lidar, std::uint64_t packets, Use&& use) {
  Monitor monitor;
  auto decoder = velodyne::Lidar::create({}, SourceId{0}, monitor);
  ASSERT_TRUE(decoder);
  for (std::uint64_t n = 0; n < packets; ++n) {
    const auto scan = (*decoder)->decode(data_packet(lidar, n));
    ASSERT_TRUE(scan) << to_string(scan.error());
    if (*scan != nullptr) use(**scan);
  }
  if (const Scan* scan = (*decoder)->flush()) use(*scan);
  EXPECT_EQ((*decoder)->counters().lost_packets, 0u);
  EXPECT_EQ((*decoder)->counters().data_packets, packets);
}

double vertical_offset(std::uint8_t ring) {
  for (const velodyne::Channel& c : vlp16().channels) {
    if (c.ring == ring) return c.vertical_offset_m;
  }
  return 0;
}

struct Residual {
  double along_ray;  ///< measured minus true distance, m
  double to_wall;    ///< of the point to the wall it was shot at, m
};

/// The wall that the ray of point `i` hits, by hand.
Residual residual(const Scan& scan, std::size_t i, const SE3& T_world_sensor) {
  const Vector3d lens(0, 0, vertical_offset(scan.cloud.ring[i]));
  const Vector3d ray = scan.cloud.xyz[i].cast<double>() - lens;
  const Vector3d origin = T_world_sensor * lens, direction = T_world_sensor.quaternion() * ray.normalized();
  double nearest = 1e9, cosine = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double wall = direction[axis] > 0 ? kHigh[axis] : kLow[axis];
    const double distance = (wall - origin[axis]) / direction[axis];
    if (distance < nearest) {
      nearest = distance;
      cosine = std::abs(direction[axis]);
    }
  }
  return {ray.norm() - nearest, (ray.norm() - nearest) * cosine};
}

TEST(SimulatedLidar, DecodesToTheWallsOfARoomThoughTheRobotMoves) {
  const Tracer tracer = box_room();
  for (const Trajectory& trajectory : {at_rest(), on_circle()}) {
    const LidarConfig config = perfect();
    const Lidar lidar(vlp16(), tracer, trajectory, config, kStartUtcNs, 1);
    const SE3 T_base_sensor = SE3::from_xyz_rpy(config.base_sensor_xyz_rpy);
    std::size_t points = 0;
    decode(lidar, 600, [&](const Scan& scan) {
      for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
        // The decoder stamps arrivals less the time of flight through the packet; the latency is in it.
        const Time fired = scan.valid.start + Duration{scan.cloud.offset_ns[i]} - config.latency;
        // 1 mm of rounding, 0.005° of azimuth at 8 m, and 0.1 ms of clock: 3 mm in all.
        ASSERT_LT(std::abs(residual(scan, i, trajectory.T_world_base(fired) * T_base_sensor).to_wall), 3e-3);
      }
      points += scan.cloud.size();
    });
    EXPECT_EQ(points, 600u * 384u);
  }
}

TEST(SimulatedLidar, SeesWallsThroughClearGlassAndTheGlassAlmostSquarelyOnly) {
  Mesh mesh;
  mesh.box({0, 0, 0, 0}, 12, 8, 3, Material::kPlaster);
  mesh.quad({3, -4, 0}, {3, 4, 0}, {3, 4, 3}, {3, -4, 3}, Material::kClearGlass);
  const Tracer tracer = std::move(*Tracer::build(mesh));
  const LidarConfig config = perfect(100);
  const Trajectory trajectory = at_rest();
  const Lidar lidar(vlp16(), tracer, trajectory, config, kStartUtcNs, 1);
  const SE3 T_world_sensor = trajectory.T_world_base(kStart) * SE3::from_xyz_rpy(config.base_sensor_xyz_rpy);
  int on_glass = 0, behind = 0;
  decode(lidar, 150, [&](const Scan& scan) {
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const Vector3d point = T_world_sensor * scan.cloud.xyz[i].cast<double>();
      if (residual(scan, i, T_world_sensor).along_ray > -0.02) {
        behind += point.x() > 3.1 ? 1 : 0;
        continue;
      }
      ++on_glass;
      EXPECT_NEAR(point.x(), 3, 0.01);
      EXPECT_GT((point - T_world_sensor.translation()).normalized().x(), 0.96) << "within 16 degrees of its normal";
    }
  });
  EXPECT_GT(on_glass, 20);
  EXPECT_GT(behind, 1000);
}

TEST(SimulatedLidar, MotionDistortsAScan) {
  // The same check with one pose for a whole scan must fail, or nothing was distorted.
  const Tracer tracer = box_room();
  const Trajectory trajectory = on_circle();
  const Lidar lidar(vlp16(), tracer, trajectory, perfect(), kStartUtcNs, 1);
  double worst = 0;
  decode(lidar, 300, [&](const Scan& scan) {
    const SE3 T = trajectory.T_world_base(scan.valid.end) * SE3::from_xyz_rpy(perfect().base_sensor_xyz_rpy);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) worst = std::max(worst, std::abs(residual(scan, i, T).to_wall));
  });
  EXPECT_GT(worst, 0.1);
}

TEST(SimulatedLidar, RangesAreNormalWithTheConfiguredSigma) {
  const Tracer tracer = box_room();
  const Trajectory trajectory = at_rest();
  LidarConfig config = perfect();
  config.range_noise_m = 0.02;
  const Lidar lidar(vlp16(), tracer, trajectory, config, kStartUtcNs, 7);
  const SE3 T = trajectory.T_world_base(kStart) * SE3::from_xyz_rpy(config.base_sensor_xyz_rpy);
  double sum = 0, squares = 0;
  int n = 0, outside = 0;
  decode(lidar, 300, [&](const Scan& scan) {
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const double error = residual(scan, i, T).along_ray;
      if (std::abs(error) > 0.2) continue;  // noise took the point around a corner of the room
      sum += error;
      squares += error * error;
      outside += std::abs(error) > 0.06 ? 1 : 0;
      ++n;
    }
  });
  EXPECT_GT(n, 110000);
  EXPECT_NEAR(sum / n, 0.0, 5e-4);
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 5e-4);
  EXPECT_NEAR(static_cast<double>(outside) / n, 0.0027, 0.002);
}

TEST(SimulatedLidar, DropsTheConfiguredShareAndWhatIsTooNearOrTooFar) {
  const Tracer tracer = box_room();
  const Trajectory trajectory = at_rest();
  LidarConfig config = perfect();
  const auto share = [&](const LidarConfig& c) {
    const Lidar lidar(vlp16(), tracer, trajectory, c, kStartUtcNs, 7);
    Lidar::DataPacket bytes;
    int returns = 0;
    for (std::uint64_t n = 0; n < 100; ++n) returns += lidar.fill(n, bytes);
    return returns / (100.0 * 384.0);
  };
  EXPECT_EQ(share(config), 1.0);
  config.dropout = 0.1;
  EXPECT_NEAR(share(config), 0.9, 0.01);
  config = perfect();
  config.max_range_m = 1.0;
  EXPECT_EQ(share(config), 0.0);
  config = perfect();
  config.min_range_m = 50.0;
  EXPECT_EQ(share(config), 0.0);
  config = perfect();
  config.half_range_m = 2.0;  // of a 10 % surface; plaster has 75 %
  EXPECT_GT(share(config), 0.2);
  EXPECT_LT(share(config), 0.9);
}

TEST(SimulatedLidar, PacketsAreThoseOfAVlp16) {
  const Tracer tracer = box_room();
  const Trajectory trajectory = at_rest();
  const Lidar lidar(vlp16(), tracer, trajectory, LidarConfig{}, kStartUtcNs, 3);
  std::uint32_t previous = 0;
  for (std::uint64_t n = 0; n < 200; ++n) {
    const Packet packet = data_packet(lidar, n);
    ASSERT_EQ(packet.bytes.size(), velodyne::kDataBytes);
    EXPECT_EQ(load_le<std::uint8_t>(packet.payload(), velodyne::kReturnModeOffset), 0x37);
    EXPECT_EQ(load_le<std::uint8_t>(packet.payload(), velodyne::kProductOffset), 0x22);
    const auto stamp = load_le<std::uint32_t>(packet.payload(), velodyne::kTimestampOffset);
    if (n > 0) {
      EXPECT_NEAR(static_cast<double>(stamp - previous), 1327.104, 1.0);
      EXPECT_EQ((lidar.arrival(n) - lidar.arrival(n - 1)).count(), 1'327'104);
    }
    previous = stamp;
    // 10 Hz: 0.36° per 100 µs, so 0.398° from block to block.
    for (std::size_t b = 1; b < 12; ++b) {
      const int from = load_le<std::uint16_t>(packet.payload(), 100 * (b - 1) + velodyne::kBlockAzimuthOffset);
      const int to = load_le<std::uint16_t>(packet.payload(), 100 * b + velodyne::kBlockAzimuthOffset);
      EXPECT_NEAR((to - from + 36000) % 36000, 39.8, 1.0);
    }
  }
}

TEST(SimulatedLidar, APacketDependsOnItsNumberAndSeedAlone) {
  const Tracer tracer = box_room();
  const Trajectory trajectory = on_circle();
  const Lidar a(vlp16(), tracer, trajectory, LidarConfig{}, kStartUtcNs, 3);
  const Lidar b(vlp16(), tracer, trajectory, LidarConfig{}, kStartUtcNs, 3);
  const Lidar c(vlp16(), tracer, trajectory, LidarConfig{}, kStartUtcNs, 4);
  for (const std::uint64_t n : {50u, 3u, 17u}) EXPECT_EQ(data_packet(a, n).bytes, data_packet(b, n).bytes);
  EXPECT_NE(data_packet(a, 3).bytes, data_packet(c, 3).bytes);
}

TEST(SimulatedLidar, IntensityTellsMaterialsApart) {
  const Trajectory trajectory = at_rest();
  const auto brightest = [&](Material material) {
    const Tracer tracer = box_room(material);
    const Lidar lidar(vlp16(), tracer, trajectory, perfect(), kStartUtcNs, 1);
    float most = 0;
    decode(lidar, 80, [&](const Scan& scan) {
      for (const float i : scan.cloud.intensity) most = std::max(most, i);
    });
    return most;
  };
  EXPECT_NEAR(static_cast<double>(brightest(Material::kPlaster)), 75, 2);
  EXPECT_NEAR(static_cast<double>(brightest(Material::kAsphalt)), 15, 2);
  EXPECT_GT(brightest(Material::kRetroreflector), 100.0F);
  EXPECT_EQ(brightest(Material::kDarkGlass), 0.0F);
}

TEST(SimulatedLidar, PositionPacketsTellUtcWhenLocked) {
  const Tracer tracer = box_room();
  const Trajectory trajectory = at_rest();
  for (const bool pps : {false, true}) {
    LidarConfig config;
    config.pps = pps;
    const Lidar lidar(vlp16(), tracer, trajectory, config, kStartUtcNs, 3);
    Lidar::PositionPacket bytes;
    const Time t = kStart + std::chrono::milliseconds(2500);
    lidar.fill_position(t, bytes);
    Packet packet;
    packet.channel = velodyne::kDefaultPositionPort;
    packet.arrival = t;
    packet.bytes.assign(bytes.begin(), bytes.end());
    Monitor monitor;
    auto decoder = velodyne::Lidar::create({}, SourceId{0}, monitor);
    ASSERT_TRUE(decoder);
    ASSERT_TRUE((*decoder)->decode(packet));
    const velodyne::Counters& counters = (*decoder)->counters();
    EXPECT_EQ(counters.bad_nmea, 0u);
    ASSERT_TRUE(counters.pps);
    EXPECT_EQ(*counters.pps, pps ? velodyne::PpsState::kLocked : velodyne::PpsState::kAbsent);
    EXPECT_EQ(counters.nmea.has_value(), pps);
    if (pps) {
      // 06:00:02.5 on the hour
      EXPECT_EQ(load_le<std::uint32_t>(packet.payload(), velodyne::kPositionTimestampOffset), 2'500'000u);
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + velodyne::kNmeaOffset);
      EXPECT_EQ(text.substr(0, 16), "$GPRMC,060002,A,");
      EXPECT_NE(text.find(",010626,"), std::string_view::npos);
    }
  }
}

}  // namespace
}  // namespace cairn::simulator
