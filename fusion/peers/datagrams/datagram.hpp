// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/peers/items/bodies.hpp"
#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/peers/items/version_set.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// What robots send each other: datagrams of at most kMaxDatagram bytes, each readable alone. All numbers are little
// endian. A varint has 7 bits in each byte, the lowest first, and no byte more than it needs. A datagram begins with
// kFormat (1 byte), the parts that it has (1 byte, see DatagramPart), and the sender (8 bytes). The parts follow in the
// order of their bits. Equal datagrams have equal bytes.
namespace cairn::peers {

inline constexpr std::size_t kMaxDatagram = 1200;
inline constexpr std::uint8_t kFormat = 5;

/// "I am here." It is also sent to robots that were never heard of.
struct Hello {
  /// The newest hello of the receiver, sent back: the receiver finds the difference of the clocks from it.
  struct Echo {
    RobotId robot = 0;
    Time stamp{};    ///< as the receiver wrote it, its clock
    Duration age{};  ///< how long ago it came
  };
  /// Where the sender is, in its odom frame, with standard deviations. It is sent in centimetres and milliradians.
  struct Place {
    std::array<double, 3> position_m{};
    double yaw_rad = 0;                 ///< −π…π
    double sigma_m = 0, sigma_rad = 0;  ///< the largest standard deviation of each
    friend bool operator==(const Place&, const Place&) = default;
  };
  static constexpr std::size_t kMaxName = 24;

  Epoch epoch = 0;
  Version newest = 0;  ///< that the sender has published in this epoch
  Time stamp{};        ///< the sender's clock
  std::string name;    ///< for people
  std::optional<Echo> echo{};
  std::uint32_t voxel_um = 0;  ///< edge of its map's voxels, micrometres; only maps of equal voxels are exchanged
  std::optional<Place> place{};
};

/// "This I know of each robot." A peer that knows more sends it.
struct Digest {
  /// The versions of one robot that the sender knows.
  struct Layer {
    RobotId robot = 0;
    Epoch epoch = 0;
    bool direct = false;  ///< the sender hears that robot itself
    VersionSet known{};
  };
  static constexpr std::size_t kMaxLayers = 32;
  std::vector<Layer> layers;
};

/// Items of one robot, which any robot may send.
struct Items {
  RobotId robot = 0;
  Epoch epoch = 0;
  VersionSet superseded;            ///< nothing is left of these
  std::vector<ItemUpdate> updates;  ///< payloads point into what was decoded
};

/// Parts that are due together go in one datagram: the headers around it take a hundred bytes.
struct Datagram {
  RobotId sender = 0;
  std::optional<Hello> hello;
  Digest digest;  ///< there is none if it has no layers
  std::optional<Items> items;
  std::optional<Bodies> bodies{};  ///< never together with items: they are left out then
};

/// The bytes of a datagram, and how much of the input it holds.
struct EncodedDatagram {
  std::vector<std::byte> bytes;
  std::size_t updates = 0;  ///< how many of the items it holds
};

/// Encodes as much as fits into one datagram:
/// - In a name, characters that are not printable ASCII become '?'. A long name is cut.
/// - The last layers of a digest are left out if they do not fit, and the highest ranges of versions. Together with
///   items, all ranges beyond kMaxRangeBytes are left out.
/// - Ranges of superseded versions beyond kMaxRangeBytes are left out.
/// - As many updates as fit are taken, from the first. They need not be in order.
[[nodiscard]] EncodedDatagram encode(const Datagram& datagram);
inline constexpr std::size_t kMaxRangeBytes = 200;

/// The sender that a datagram names, even if the rest cannot be decoded; 0 if it names none.
[[nodiscard]] RobotId sender_of(std::span<const std::byte> bytes);
/// Payloads are checked too. Errors: kTruncated, kMalformed, kUnsupported (another format), kLimit (too long).
[[nodiscard]] Result<Datagram> decode_datagram(std::span<const std::byte> bytes);

}  // namespace cairn::peers
