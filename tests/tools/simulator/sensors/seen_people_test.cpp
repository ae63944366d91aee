// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/seen_people.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "hal/workers.hpp"
#include "tests/tools/simulator/sensors/scene_with_people.hpp"
#include "tools/simulator/sensors/stereo.hpp"
#include "tools/simulator/sensors/thermal_camera.hpp"

namespace cairn::simulator {
namespace {

constexpr LeastSeen kAnything{1, 0.0};

/// A person of the crowd who stands as one capsule, and rays that meet it or a wall.
Figure capsule_person(int person, double x, double y, double radius) {
  Figure figure;
  figure.person = person;
  for (Capsule& part : figure.parts) part = {{x, y, -0.5}, {x, y, 0.5}, radius, Material::kSkin};
  figure.centre = {x, y, 0};
  figure.reach = 2.0;
  return figure;
}

/// The sightings of row `row`, without any world: the nearest person, or the sky.
std::vector<Sighting> row_of(const Lens& lens, int row, const std::vector<Figure>& figures) {
  std::vector<Sighting> seen(static_cast<std::size_t>(lens.width));
  for (int u = 0; u < lens.width; ++u) {
    Sighting& s = seen[static_cast<std::size_t>(u)];
    s.direction = lens.direction(u, row);
    if (const auto hit = trace(figures, {Eigen::Vector3d::Zero(), s.direction}, kSight)) {
      s.distance = hit->distance;
      s.person = hit->figure->person;
    }
  }
  return seen;
}

SeenPeople see(const Lens& lens, const std::vector<Figure>& figures) {
  SeenPeople people;
  people.begin(figures.size(), lens.height);
  for (int row = 0; row < lens.height; ++row)
    people.add_row(row, Eigen::Vector3d::Zero(), row_of(lens, row, figures), figures);
  return people;
}

const Lens kSmall{100, 80, 100, 100, 50, 40};

TEST(SeenPeople, ABoxSurroundsWhoIsSeen) {
  const auto boxes = see(kSmall, {capsule_person(0, 5, 0, 0.25)}).boxes({});
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_EQ(boxes[0].class_id, kPersonClass);
  EXPECT_EQ(boxes[0].score, 1.0F);
  EXPECT_NEAR(boxes[0].x + boxes[0].width / 2, 50, 0.6);
  EXPECT_NEAR(boxes[0].y + boxes[0].height / 2, 40, 0.6);
  EXPECT_NEAR(boxes[0].width, 10, 1.1) << "0.5 m at 5 m";
  EXPECT_NEAR(boxes[0].height, 30, 1.6) << "1.5 m at 5 m";
}

TEST(SeenPeople, TheScoreIsTheVisibleShare) {
  // The nearer one hides half of the farther one's width.
  const std::vector<Figure> figures{capsule_person(0, 10, 0, 0.5), capsule_person(1, 5, 0.25, 0.25)};
  const auto boxes = see(kSmall, figures).boxes({});
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_NEAR(boxes[0].score, 0.5F, 0.06F);
  EXPECT_EQ(boxes[1].score, 1.0F);
  EXPECT_NEAR(boxes[0].x, 50, 1.1) << "the box is that of the visible part";
}

TEST(SeenPeople, WhoIsHardlySeenIsLeftOut) {
  const std::vector<Figure> hidden{capsule_person(0, 10, 0, 0.3), capsule_person(1, 5, 0.0, 0.1)};
  const SeenPeople people = see(kSmall, hidden);
  const auto all = people.boxes(kAnything);
  ASSERT_EQ(all.size(), 2U);
  const double share = all[0].score;
  ASSERT_LT(share, 0.5);
  EXPECT_EQ(people.boxes({1, share + 0.01}).size(), 1U);
  EXPECT_EQ(people.boxes({1, share - 0.01}).size(), 2U);
  EXPECT_EQ(people.boxes({1000, 0.0}).size(), 0U) << "too few pixels";
  EXPECT_TRUE(see(kSmall, {capsule_person(0, -5, 0, 0.25)}).boxes(kAnything).empty()) << "behind the camera";
}

/// The boxes of a picture, and the packet without and with somebody who asks for them.
struct People {
  std::vector<Detection> boxes;
  std::vector<std::byte> labels;
  bool same_packet = false;
};

People people_of(const Stereo& stereo, Time t, unsigned threads) {
  Workers workers(threads);
  Packet asked, alone;
  SeenPeople seen;
  People people;
  stereo.shoot(3, t, workers, alone, people.labels);
  stereo.shoot(3, t, workers, asked, people.labels, &seen);
  people.boxes = seen.boxes(kAnything);
  people.same_packet = asked.bytes == alone.bytes;
  return people;
}

bool in(const Detection& d, int u, int v) {
  const auto x = static_cast<float>(u), y = static_cast<float>(v);
  return x >= d.x && x < d.x + d.width && y >= d.y && y < d.y + d.height;
}

TEST(SeenPeople, TheBoxesHoldThePixelsThatTheLabelsCallPeople) {
  const SceneWithPeople scene("street", 8);
  const auto [person, t] = scene.somebody();
  const Trajectory robot = scene.looking_at(person, t);
  for (const double line_time_s : {0.0, 1e-3}) {
    StereoConfig config;
    config.lens = {168, 94, 87.5, 87.5, 84, 47};
    config.line_time_s = line_time_s;
    const Stereo stereo(config, scene.tracer, scene.crowd, scene.climate, robot, 1);
    const People people = people_of(stereo, t, 2);
    EXPECT_TRUE(people.same_packet);
    ASSERT_FALSE(people.boxes.empty());
    std::vector<int> pixels(people.boxes.size(), 0);
    for (int v = 0; v < config.lens.height; ++v)
      for (int u = 0; u < config.lens.width; ++u) {
        if (people.labels[static_cast<std::size_t>(v * config.lens.width + u)] != std::byte{kPersonClass}) continue;
        bool held = false;
        for (std::size_t i = 0; i < pixels.size(); ++i)
          if (in(people.boxes[i], u, v)) held = ++pixels[i] > 0;
        EXPECT_TRUE(held) << u << ", " << v;
      }
    EXPECT_TRUE(std::ranges::none_of(pixels, [](int n) { return n == 0; }));
    const auto serial = people_of(stereo, t, 1).boxes;
    ASSERT_EQ(serial.size(), people.boxes.size());
    for (std::size_t i = 0; i < serial.size(); ++i) EXPECT_EQ(serial[i].score, people.boxes[i].score);
  }
}

TEST(SeenPeople, AFrozenThermalPictureShowsPeopleWhereTheyWere) {
  const SceneWithPeople scene("street", 8, true);
  const auto [person, t] = scene.somebody();
  const Trajectory robot = scene.looking_at(person, t);
  ThermalConfig config;
  config.correction_period = std::chrono::seconds(1000);
  config.correction_length = std::chrono::seconds(999);  // nearly always
  const ThermalCamera frozen(config, scene.tracer, scene.crowd, scene.climate, robot, 1);
  Workers workers(1);
  Packet packet;
  SeenPeople seen;
  const auto boxes = [&, t = t](const ThermalCamera& camera, Duration later) {
    camera.shoot(1, t + later, workers, packet, &seen);
    return seen.boxes(kAnything);
  };
  const auto then = boxes(frozen, Duration{}), still = boxes(frozen, std::chrono::seconds(1));
  ASSERT_EQ(then.size(), still.size());
  for (std::size_t i = 0; i < then.size(); ++i) EXPECT_EQ(then[i].x, still[i].x);
  const ThermalCamera live({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  ASSERT_FALSE(boxes(live, Duration{}).empty());
  EXPECT_NE(boxes(live, Duration{})[0].x, boxes(live, std::chrono::seconds(1))[0].x);
}

}  // namespace
}  // namespace cairn::simulator
