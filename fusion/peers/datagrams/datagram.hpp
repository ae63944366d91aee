// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/peers/items/version_set.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// What robots send each other: datagrams of at most kMaxDatagram bytes, each readable alone. All numbers are little
// endian; a varint has 7 bits in each byte, the lowest first, and no byte more than it needs. A datagram begins with
// kFormat (1 byte), the parts that it has (1, see DatagramPart), and the sender (8); the parts follow in the order of
// their bits. There is one way only to write what it says.
namespace cairn::peers {

inline constexpr std::size_t kMaxDatagram = 1200;
inline constexpr std::uint8_t kFormat = 3;

/// "I am here." Sent also to robots never heard of.
struct Hello {
  /// The newest hello of the robot it is sent to, and how long ago it came: from this the other knows the difference
  /// of the clocks.
  struct Echo {
    RobotId robot = 0;
    Time stamp{};  ///< as the other wrote it
    Duration age{};
  };
  /// Where the sender is, in its odom frame, and how well it knows. Sent in centimetres and milliradians.
  struct Place {
    std::array<double, 3> position_m{};
    double yaw_rad = 0;                 ///< −π…π
    double sigma_m = 0, sigma_rad = 0;  ///< the largest standard deviation of each
    friend bool operator==(const Place&, const Place&) = default;
  };
  static constexpr std::size_t kMaxName = 24;

  Epoch epoch = 0;
  Version newest = 0;  ///< of what the sender says in this epoch
  Time stamp{};        ///< sender's clock
  std::string name;    ///< for people
  std::optional<Echo> echo;
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

/// Together in one where they are due together: what carries a datagram is a hundred bytes itself.
struct Datagram {
  RobotId sender = 0;
  std::optional<Hello> hello;
  Digest digest;  ///< without layers: none
  std::optional<Items> items;
};

struct EncodedDatagram {
  std::vector<std::byte> bytes;
  std::size_t updates = 0;  ///< of the items', how many it holds
};

/// What of a name is not printable ASCII becomes '?'; what is too long is cut. Layers that do not fit, of the last
/// ones, are left out; ranges of versions too, the highest first (with items, all beyond kMaxRangeBytes). Of the
/// updates as many as fit, from the first; they need not be in order. Ranges of superseded versions beyond
/// kMaxRangeBytes are left out.
[[nodiscard]] EncodedDatagram encode(const Datagram& datagram);
inline constexpr std::size_t kMaxRangeBytes = 200;

/// Who a datagram claims to be from, whatever is wrong with the rest; 0 where it does not say.
[[nodiscard]] RobotId sender_of(std::span<const std::byte> bytes);
/// kTruncated, kMalformed, kUnsupported (another format) or kLimit (too long). Payloads are checked too.
[[nodiscard]] Result<Datagram> decode_datagram(std::span<const std::byte> bytes);

}  // namespace cairn::peers
