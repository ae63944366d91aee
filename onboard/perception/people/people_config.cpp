// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/people_config.hpp"

namespace cairn::people {

void declare(config::Section& s, DetectorTrust& t) {
  s.number("recall", t.recall, {0.01, 0.99}, "", "share of the people in view that the detector finds in a picture");
  s.number("false_share", t.false_share, {0.001, 0.5}, "",
           "share of other person-sized things in view that it takes for people");
  s.number("usual_score", t.usual_score, {0, 1}, "", "score of a box that shows a person");
  s.number("score_slope", t.score_slope, {0, 100}, "nat",
           "a box counts so much more for each 1 of a larger score; 0: all boxes count alike");
  s.number("farthest_m", t.farthest_m, {1, 100}, "m",
           "from here on, silence of the detector means nothing; nearer, it means ever more");
}

void declare(config::Section& s, PeopleConfig& c) {
  s.choice("follow", c.follow, {"auto", "always", "never"},
           "people are followed and stay out of the map: auto where a detector looks at pictures and a LiDAR "
           "measures, always also by scans alone, or by the points of both eyes");
  s.choice("points", c.points, {"auto", "scans", "depth"},
           "where people are looked for: in scans (without a LiDAR the points of both eyes), or in the clouds of the "
           "depth camera that the map gets; auto: in clouds where there are some, and no LiDAR");
  s.flag("movers", c.movers, "also follow walkers, and upright bodies that came, that the LiDAR alone sees");
  s.number("farthest_m", c.farthest_m, {2, 40}, "m", "nobody is looked for beyond it");
  s.number("confirm", c.confirm, {0.5, 10}, "nat", "evidence from which somebody is a person");
  s.number("patience_s", c.patience_s, {0.1, 10}, "s", "a track ends when nothing was seen of it for so long");
  s.number("mask_radius_m", c.mask_radius_m, {0.1, 2}, "m", "points so near to a person's middle stay out of the map");
  s.flag("log_answers", c.log_answers,
         "what the detectors say of each body goes to answers.csv of the run, for cairn evaluate detectors");
  s.group("visible", c.visible, "how far the detector of colour pictures is trusted");
  s.group("thermal", c.thermal, "how far the detector of thermal pictures is trusted");
}

}  // namespace cairn::people
