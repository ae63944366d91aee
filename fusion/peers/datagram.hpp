// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "fusion/peers/holding.hpp"
#include "fusion/peers/item.hpp"
#include "fusion/peers/version_set.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// What robots send each other: datagrams of at most kMaxDatagram bytes, each readable alone. All numbers are little
// endian; a varint has 7 bits in each byte, the lowest first, and no byte more than it needs. A datagram begins with
// kFormat (1 byte), its kind (1), and the sender (8). There is one way only to write what it says.
namespace cairn::peers {

inline constexpr std::size_t kMaxDatagram = 1200;
inline constexpr std::uint8_t kFormat = 2;

/// "I am here." Sent to everyone, also to robots never heard of.
struct Hello {
  /// The newest hello of another robot, and how long ago it came: from this the other knows the difference of the
  /// clocks.
  struct Echo {
    RobotId robot = 0;
    Time stamp{};  ///< as the other wrote it
    Duration age{};
  };
  /// Where the sender is, in its odom frame, and how well it knows.
  struct Place {
    std::array<float, 3> position_m{};
    float yaw_rad = 0;                 ///< −π…π
    float sigma_m = 0, sigma_rad = 0;  ///< the largest standard deviation of each
    friend bool operator==(const Place&, const Place&) = default;
  };
  static constexpr std::size_t kMaxName = 24, kMaxEchoes = 32;

  Epoch epoch = 0;
  Version newest = 0;  ///< of what the sender says in this epoch
  Time stamp{};        ///< sender's clock
  std::string name;    ///< for people
  std::vector<Echo> echoes;
  std::uint32_t voxel_um = 0;  ///< edge of its map's voxels in micrometres; maps of other voxels are not exchanged
  std::optional<Place> place{};
};

/// "This I know of each robot." Whoever knows more sends it.
struct Digest {
  struct Layer {
    RobotId robot = 0;
    Epoch epoch = 0;
    bool direct = false;  ///< the sender hears that robot itself
    VersionSet known;
  };
  static constexpr std::size_t kMaxLayers = 32;
  std::vector<Layer> layers;
};

/// Items of one robot, in ascending order of their ids, whoever sends them.
struct Items {
  RobotId robot = 0;
  Epoch epoch = 0;
  VersionSet superseded;            ///< nothing is left of these
  std::vector<ItemUpdate> updates;  ///< payloads point into what was decoded
};

struct Datagram {
  RobotId sender = 0;
  std::variant<Hello, Digest, Items> content;
};

/// What of a name is not printable ASCII becomes '?'; what is too long is cut.
[[nodiscard]] std::vector<std::byte> encode(RobotId sender, const Hello& hello);
/// Layers that do not fit, of the last ones, are left out; ranges of versions too, the highest first.
[[nodiscard]] std::vector<std::byte> encode(RobotId sender, const Digest& digest);
/// As many of the updates as fit, from the first; they need not be in order. `count` says how many. Ranges of
/// superseded versions that do not fit into kMaxSuperseded are left out.
[[nodiscard]] std::vector<std::byte> encode(RobotId sender, const Items& items, std::size_t& count);
inline constexpr std::size_t kMaxSuperseded = 200;

/// Who a datagram claims to be from, whatever is wrong with the rest; 0 where it does not say.
[[nodiscard]] RobotId sender_of(std::span<const std::byte> bytes);
/// kTruncated, kMalformed, kUnsupported (another format) or kLimit (too long). Payloads are checked too.
[[nodiscard]] Result<Datagram> decode_datagram(std::span<const std::byte> bytes);

}  // namespace cairn::peers
