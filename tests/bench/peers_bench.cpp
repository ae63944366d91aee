// SPDX-License-Identifier: Apache-2.0
// What exchange and fusion of tiles cost: bytes beside zstd's, decoding of the worst that a peer can send, slices.
#include <benchmark/benchmark.h>
#include <zstd.h>

#include <random>

#include "fusion/merging/team_map.hpp"
#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::peers {
namespace {

constexpr double kMiB = 1 << 20;

struct Lobby {
  Lobby() : pair(support::two_robots(support::lobby(), {0, 3.4, 30}, {2.2, 5.6, 30}, 1)) {
    for (const mapping::TileKey tile : mapping::known_tiles(*pair.a, 1U << 20U))
      tiles.emplace_back(tile, mapping::read_tile(*pair.a, tile));
  }
  support::MapPair pair;
  std::vector<std::pair<mapping::TileKey, mapping::TileState>> tiles;
};
const Lobby& lobby() {
  static const Lobby lobby;
  return lobby;
}

/// One byte for each voxel.
std::vector<std::byte> plain(const mapping::TileState& tile) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < 512; ++i) {
    const float value = tile.log_odds(i & 7U, i >> 3 & 7U, i >> 6);
    bytes.push_back(value == mapping::SemanticNode::kAbsent
                        ? std::byte{0}
                        : static_cast<std::byte>(static_cast<int>(value * 10) + 50));
  }
  return bytes;
}

std::size_t zstd_bytes(const std::vector<std::byte>& bytes) {
  std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
  return ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 19);
}

void BM_EncodeTiles(benchmark::State& state) {
  std::vector<std::byte> out;
  (void)lobby();
  for (auto _ : state) {
    out.clear();
    for (const auto& [key, tile] : lobby().tiles) peers::encode_tile(tile, out);
  }
  double alone = 0, sixteen = 0;
  std::vector<std::byte> batch;
  for (std::size_t i = 0; i < lobby().tiles.size(); ++i) {
    const auto bytes = plain(lobby().tiles[i].second);
    alone += static_cast<double>(zstd_bytes(bytes));
    batch.insert(batch.end(), bytes.begin(), bytes.end());
    if (i % 16 != 15) continue;
    sixteen += static_cast<double>(zstd_bytes(batch));
    batch.clear();
  }
  const auto count = static_cast<double>(lobby().tiles.size());
  state.counters["tiles"] = count;
  state.counters["bytes"] = static_cast<double>(out.size()) / count;
  state.counters["zstd_alone"] = alone / count;
  state.counters["zstd_of_16"] = sixteen / count;
}
BENCHMARK(BM_EncodeTiles)->Unit(benchmark::kMillisecond);

/// Datagrams of what a peer may choose to send.
std::vector<std::vector<std::byte>> datagrams(int kind) {
  std::mt19937 random(1);
  std::vector<std::vector<std::byte>> payloads;
  for (unsigned i = 0; i < 300; ++i) {
    mapping::TileState tile;
    if (kind == 0)  // as they come
      tile = lobby().tiles[(7 * i) % lobby().tiles.size()].second;
    for (unsigned v = 0; v < 512 && kind > 0; ++v) {
      const bool put = kind == 1 || (kind == 2 ? v == i % 512 : kind == 3 ? v % 64 < 8 : random() % 2 == 0);
      if (put) tile.set(v & 7U, v >> 3 & 7U, v >> 6, kind == 4 ? 1.5F : -2);
    }
    payloads.emplace_back();
    peers::encode_tile(tile, payloads.back());
  }
  peers::Datagram next{2, {}, {}, peers::Items{2, 1, {}, {}}};
  auto& updates = next.items->updates;
  for (unsigned i = 0; i < payloads.size(); ++i)
    updates.push_back({peers::ItemId::tile(0, {i}), 1 + i, 0, payloads[i]});
  std::vector<std::vector<std::byte>> all;
  while (!updates.empty()) {
    auto [bytes, count] = encode(next);
    all.push_back(std::move(bytes));
    updates.erase(updates.begin(), updates.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

void BM_DecodeDatagrams(benchmark::State& state) {
  const auto all = datagrams(static_cast<int>(state.range(0)));
  std::size_t bytes = 0;
  for (auto _ : state)
    for (const auto& datagram : all) {
      benchmark::DoNotOptimize(peers::decode_datagram(datagram));
      bytes += datagram.size();
    }
  state.counters["ms_per_MiB"] = benchmark::Counter(static_cast<double>(bytes) / kMiB * 1e-3,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_DecodeDatagrams)->ArgName("as_they_come_uniform_one_voxel_rows_noise")->DenseRange(0, 4);

void BM_FuseTile(benchmark::State& state) {
  const auto& map = *lobby().pair.b;
  const auto tiles = mapping::known_tiles(map, 1U << 20U);
  std::vector<double> steps;
  for (auto _ : state) {
    merging::TeamMap team(map.getResolution(), merging::Policy::kRelativeEntropy);
    for (std::uint64_t robot = 1; robot <= static_cast<std::uint64_t>(state.range(0)); ++robot)
      for (const mapping::TileKey tile : tiles) team.put({robot, 0}, tile, mapping::read_tile(map, tile), Time{});
    merging::SubmapPoses poses;
    for (std::uint64_t robot = 1; robot <= static_cast<std::uint64_t>(state.range(0)); ++robot)
      poses[{robot, 0}] = robot == 1 ? SE3() : lobby().pair.T_a_b;
    team.place(poses);
    Budget budget = Budget::steps(1'000'000);
    benchmark::DoNotOptimize(team.fuse(budget));
    state.counters["steps"] = budget.spent();
  }
}
BENCHMARK(BM_FuseTile)->ArgName("robots")->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn::peers

BENCHMARK_MAIN();
