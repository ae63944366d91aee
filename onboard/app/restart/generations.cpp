// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/generations.hpp"

#include <xxhash.h>

#include <algorithm>
#include <new>
#include <string>
#include <system_error>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/cairn_file.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxStateBytes = 4096;
// Forty scans of the largest LiDAR, thinned, are less than half of that.
constexpr std::uint64_t kMaxScansBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kMaxKeyframesBytes = std::uint64_t{16} << 20;  // ten of the most corners take 3 MB
constexpr std::size_t kHashLine = 17;                                  // 16 hexadecimal digits and the end of the line

std::string hash_line(std::string_view text) {
  std::string hex(kHashLine - 1, '0');
  std::uint64_t hash = XXH3_64bits(text.data(), text.size());
  for (auto digit = hex.rbegin(); digit != hex.rend(); ++digit, hash >>= 4U) *digit = "0123456789abcdef"[hash & 15U];
  return hex + "\n";
}

Result<SavedState> parse_state_file(std::string_view text) {
  const bool long_enough = text.size() > kHashLine;
  const std::string_view body = text.substr(0, long_enough ? text.size() - kHashLine : 0);
  if (!long_enough || hash_line(body) != text.substr(body.size()))
    return Error{Errc::kMalformed, "the checksum of the saved state is wrong"};
  return parse_state(body);
}

}  // namespace

Generations::Generations(fs::path folder, Monitor& monitor, FileCalls& calls)
    : folder_(std::move(folder)), monitor_(monitor), calls_(calls) {
  std::error_code ignored;  // the first store() says what is wrong
  fs::create_directories(folder_, ignored);
}

std::optional<Generation> Generations::load_file(std::size_t slot, Time now, const mapping::MapLimits& limits) {
  const fs::path path = folder_ / kMapFiles[slot];
  const auto refuse = [&](Error error) {
    if (error.code == Errc::kNotFound) return std::nullopt;
    damaged_ = true;
    monitor_.event(now, "saved map", to_string(at(path.filename(), std::move(error))));
    return std::nullopt;
  };
  const auto bytes = read_file(path, limits.max_file_bytes);
  if (!bytes) return refuse(bytes.error());
  const auto metadata = mapping::decode_cairn_metadata(*bytes);
  if (!metadata) return refuse(metadata.error());
  auto state = parse_state(*metadata);
  if (!state) return refuse(state.error());
  auto map = mapping::decode_cairn(*bytes, limits);
  if (!map) return refuse(map.error());
  const Time stamp = state->stamp;
  const std::uint32_t epoch = state->epoch;
  return Generation{std::move(*state), std::move(*map), stamp, epoch, {}, {}};
}

std::optional<Generation> Generations::load(Time now, const mapping::MapLimits& limits) {
  std::optional<Generation> newest;
  for (std::size_t slot = 0; slot < kMapFiles.size(); ++slot) {
    auto found = load_file(slot, now, limits);
    if (!found || (newest && newest->state.sequence >= found->state.sequence)) continue;
    newest = std::move(found);
    next_ = 1 - slot;
  }
  if (!newest) return std::nullopt;
  sequence_ = newest->state.sequence;
  take_newer_pose(*newest, now);
  take_scans(*newest, now);
  take_keyframes(*newest, now);
  return newest;
}

void Generations::take_newer_pose(Generation& generation, Time now) {
  const auto bytes = read_file(folder_ / kStateFile, kMaxStateBytes);
  if (!bytes && bytes.error().code == Errc::kNotFound) return;
  auto state = bytes ? parse_state_file({reinterpret_cast<const char*>(bytes->data()), bytes->size()})
                     : Result<SavedState>(bytes.error());
  if (!state) return monitor_.event(now, "saved map", to_string(at(kStateFile, state.error())));
  const SavedState& old = generation.state;
  generation.newest_epoch = std::max(old.epoch, state->epoch);
  if (state->epoch != old.epoch || state->boot != old.boot || state->stamp < old.stamp) return;
  state->sequence = old.sequence;
  generation.state = std::move(*state);
}

void Generations::take_scans(Generation& generation, Time now) {
  const auto bytes = read_file(folder_ / kScansFile, kMaxScansBytes);
  if (!bytes && bytes.error().code == Errc::kNotFound) return;
  auto saved = bytes ? decode_scans(*bytes) : Result<SavedScans>(bytes.error());
  if (!saved) return monitor_.event(now, "saved map", to_string(at(kScansFile, saved.error())));
  if (saved->epoch == generation.state.epoch) generation.scans = std::move(saved->scans);
}

void Generations::take_keyframes(Generation& generation, Time now) {
  const auto bytes = read_file(folder_ / kKeyframesFile, kMaxKeyframesBytes);
  if (!bytes && bytes.error().code == Errc::kNotFound) return;
  auto saved = bytes ? decode_keyframes(*bytes) : Result<SavedKeyframes>(bytes.error());
  if (!saved) return monitor_.event(now, "saved map", to_string(at(kKeyframesFile, saved.error())));
  if (saved->epoch == generation.state.epoch) generation.keyframes = std::move(saved->keyframes);
}

std::vector<std::byte> Generations::encode(const mapping::SemanticOcTree& map, SavedState state) const {
  state.sequence = sequence_ + 1;
  return mapping::encode_cairn(map, to_text(state));
}

Result<void> Generations::store(std::span<const std::byte> generation) {
  if (auto stored = write_file_atomic(folder_ / kMapFiles[next_], generation, calls_); !stored) return stored;
  ++sequence_;
  next_ = 1 - next_;
  return {};
}

Result<void> Generations::save(const mapping::SemanticOcTree& map, const SavedState& state) try {
  return store(encode(map, state));
} catch (const std::bad_alloc&) {
  return Error{Errc::kLimit, "no memory to save the map"};
}

Result<void> Generations::save_state(SavedState state) {
  state.sequence = sequence_;
  std::string text = to_text(state);
  text += hash_line(text);
  return replace_file(folder_ / kStateFile, std::as_bytes(std::span(text)), calls_);
}

Result<void> Generations::save_scans(const SavedScans& scans) try {
  return replace_file(folder_ / kScansFile, cairn::app::encode(scans), calls_);
} catch (const std::bad_alloc&) {
  return Error{Errc::kLimit, "no memory to save the scans"};
}

Result<void> Generations::save_keyframes(const SavedKeyframes& keyframes) try {
  return replace_file(folder_ / kKeyframesFile, cairn::app::encode(keyframes), calls_);
} catch (const std::bad_alloc&) {
  return Error{Errc::kLimit, "no memory to save the keyframes"};
}

}  // namespace cairn::app
