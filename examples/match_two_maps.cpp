// SPDX-License-Identifier: Apache-2.0
// Where map B lies in map A, and both in one file:  match_two_maps A.cairn B.cairn [BOTH.cairn]
#include <cairn/fusion/matching/methods.hpp>
#include <cairn/fusion/merging/merge.hpp>
#include <cairn/onboard/mapping/files/map_file.hpp>
#include <cstdio>

namespace {

using namespace cairn;

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fail({Errc::kInvalidConfig, "usage: match_two_maps A.cairn B.cairn [BOTH.cairn]"});
  auto a = mapping::load_map(argv[1]), b = mapping::load_map(argv[2]);
  if (!a) return fail(a.error());
  if (!b) return fail(b.error());

  const auto features_a = matching::MapFeatures::build(**a), features_b = matching::MapFeatures::build(**b);
  if (!features_a) return fail(features_a.error());
  if (!features_b) return fail(features_b.error());
  auto matcher = matching::make_matcher(matching::method_names().front(), *features_a, *features_b);
  if (!matcher) return fail(matcher.error());
  auto budget = Budget::steps(matching::kAmpleSteps);
  const auto match = (*matcher)->match(std::nullopt, budget);  // without a first guess
  if (!match) return fail(match.error());

  const Vector6 pose = match->T_a_b.mean.xyz_rpy();
  std::printf("T_a_b: %.3f %.3f %.3f m, roll %.4f pitch %.4f yaw %.4f rad; probability %.3f: %s\n", pose[0], pose[1],
              pose[2], pose[3], pose[4], pose[5], match->probability_correct, match->accepted ? "accepted" : "refused");
  if (!match->accepted || argc < 4) return match->accepted ? 0 : 1;

  merging::Contributions maps;  // by the number of the robot; each with the version of what it saw
  maps[1] = {.version = 1, .map = std::move(*a), .T_fused_map = SE3()};
  maps[2] = {.version = 1, .map = std::move(*b), .T_fused_map = match->T_a_b.mean};
  const auto both = merging::merge(maps);
  if (!both) return fail(both.error());
  if (const auto saved = mapping::save_cairn(**both, argv[3]); !saved) return fail(saved.error());
}
