// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "drivers/drive/can/can_link.hpp"
#include "hal/clock.hpp"

/// What a robot's program takes for its devices.
namespace cairn::simulator {

/// The folder of this user's simulated devices, in memory where the system has such a place. It is made if it is not
/// there. Error kIo: it cannot be made, or belongs to somebody else.
[[nodiscard]] Result<std::filesystem::path> device_folder();

/// The CAN bus of that name: a SocketCAN interface, or unix:PATH, which is then played here (CanHub). Errors: those of
/// SocketCanLink::open() and CanHub::open().
[[nodiscard]] Result<std::unique_ptr<drive::CanLink>> open_bus(const std::string& interface, const Clock& clock);

/// The line of an e-stop: a file that holds 1 while the contact is closed, 0 while the button is pressed. See
/// gpio::FileLines.
class EStopFile {
 public:
  /// Makes the file, with the button released. One that is there keeps its content. Error kIo, with the remedy.
  [[nodiscard]] static Result<EStopFile> open(const std::filesystem::path& path);
  EStopFile(EStopFile&& other) noexcept : path_(std::move(other.path_)), made_(std::exchange(other.made_, false)) {}
  EStopFile(const EStopFile&) = delete;
  EStopFile& operator=(EStopFile&&) = delete;
  EStopFile& operator=(const EStopFile&) = delete;
  /// Removes a file that it has made: the line is gone, and the robot's program stops.
  ~EStopFile();

  [[nodiscard]] bool pressed() const;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  EStopFile(std::filesystem::path path, bool made) : path_(std::move(path)), made_(made) {}

  std::filesystem::path path_;
  bool made_;
};

}  // namespace cairn::simulator
