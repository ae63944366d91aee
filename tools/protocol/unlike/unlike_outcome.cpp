// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/unlike_outcome.hpp"

#include <algorithm>
#include <tuple>

#include "hal/clock.hpp"
#include "onboard/report/pictures/map_paint.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "tools/protocol/pairs/merged_pair.hpp"
#include "tools/protocol/report/figures.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

Result<NamedPicture> drawn(std::string title, const mapping::SemanticOcTree& map) {
  const auto seen = report::look_at(map, {});
  if (!seen) return seen.error();
  report::MapDrawing drawing;
  drawing.classes = seen->labelled();
  const auto image = report::draw_map(*seen, drawing);
  if (!image) return image.error();
  auto png = report::encode_png(*image);
  if (!png) return png.error();
  return NamedPicture{std::move(title), *std::move(png)};
}

Result<UnlikeOutcome> load_one(const fs::path& dir) {
  UnlikeOutcome one;
  auto outcome = load_pair_with_runs(dir);
  if (!outcome) return outcome.error();
  one.outcome = *std::move(outcome);
  const auto moment = load_moment(dir / "moment.json");
  if (!moment) return moment.error();
  one.moment = *moment;
  const MethodRun* run = one.outcome.run("default");
  if (run != nullptr)
    for (const Attempt& a : run->attempts)
      if (a.start == kExactStart) {
        one.attempt = a;
        return one;
      }
  return Error{Errc::kMalformed, "the default method was not run from the true pose", dir.string()};
}

Result<void> time_merging(UnlikeOutcome& one) {
  const Duration began = thread_cpu_time();
  const auto merged = merged_pair(one.outcome.pair, one.attempt.T_a_b, merging::Policy::kRelativeEntropy);
  one.merge_s = to_seconds(thread_cpu_time() - began);
  return merged ? Result<void>{} : merged.error();
}

/// What the last fusion of a scene has on top.
Result<void> add_fused(UnlikeOutcome& one) {
  auto fused = fuse_pair(one.outcome.pair, one.attempt.T_a_b);
  if (!fused) return fused.error();
  one.entropies = fused->entropies;
  one.map = std::move(fused->told_map);
  for (const auto& [title, map] :
       {std::pair{"UGV", one.outcome.pair.a}, {"UAV", one.outcome.pair.b}, {"fused", one.map}}) {
    auto picture = drawn(one.scene() + ", " + title, *map);
    if (!picture) return picture.error();
    one.pictures.push_back(*std::move(picture));
  }
  return {};
}

}  // namespace

double UnlikeOutcome::seconds(std::string_view method) const {
  const MethodRun* run = outcome.run(method);
  return run != nullptr ? run->preparation_s + figures_of(run->attempts).seconds + merge_s : 0;
}

Result<std::vector<UnlikeOutcome>> load_unlike(const fs::path& pairs) {
  std::vector<UnlikeOutcome> all;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(pairs, code)) {
    if (!fs::exists(entry.path() / "moment.json")) continue;
    auto one = load_one(entry.path());
    if (!one) return one.error();
    all.push_back(*std::move(one));
  }
  if (code) return Error{Errc::kIo, "cannot read the folder", pairs.string(), {}, code.message()};
  if (all.empty()) return Error{Errc::kNotFound, "no pairs of a UGV's and a UAV's map", pairs.string()};
  std::ranges::sort(all, {}, [](const UnlikeOutcome& o) { return std::tuple(o.scene(), o.moment.fusion); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (auto timed = time_merging(all[i]); !timed) return timed.error();
    if (i + 1 == all.size() || all[i + 1].scene() != all[i].scene())
      if (auto added = add_fused(all[i]); !added) return added.error();
    all[i].outcome.pair.a.reset();
    all[i].outcome.pair.b.reset();
  }
  return all;
}

std::vector<std::string> scenes_of(const std::vector<UnlikeOutcome>& all) {
  std::vector<std::string> scenes;
  for (const UnlikeOutcome& o : all)
    if (scenes.empty() || scenes.back() != o.scene()) scenes.push_back(o.scene());
  return scenes;
}

std::vector<const UnlikeOutcome*> fusions_of(const std::vector<UnlikeOutcome>& all, std::string_view scene) {
  std::vector<const UnlikeOutcome*> fusions;
  for (const UnlikeOutcome& o : all)
    if (o.scene() == scene) fusions.push_back(&o);
  return fusions;
}

}  // namespace cairn::protocol
