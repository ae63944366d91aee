// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_devices.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "drivers/drive/can/bus_name.hpp"
#include "drivers/drive/can/socketcan_link.hpp"
#include "hal/files/file.hpp"
#include "tools/simulator/live/can_hub.hpp"

namespace cairn::simulator {

namespace fs = std::filesystem;

Result<fs::path> device_folder() {
  const char* run = std::getenv("XDG_RUNTIME_DIR");
  const bool has_run = run != nullptr && *run == '/';
  const fs::path folder = has_run ? fs::path(run) / "cairn-live"
                                  : fs::temp_directory_path() / ("cairn-live-" + std::to_string(::geteuid()));
  constexpr ::mode_t kOwnerAlone = 0700;
  (void)::mkdir(folder.c_str(), kOwnerAlone);
  struct stat there {};
  if (::lstat(folder.c_str(), &there) == 0 && S_ISDIR(there.st_mode) && there.st_uid == ::geteuid()) return folder;
  return Error{Errc::kIo,
               "no folder of this user for simulated devices",
               folder.string(),
               {},
               "name the devices: --can unix:PATH --estop FILE"};
}

Result<std::unique_ptr<drive::CanLink>> open_bus(const std::string& interface, const Clock& clock) {
  const auto opened = [](auto bus) -> Result<std::unique_ptr<drive::CanLink>> {
    if (!bus) return bus.error();
    return std::unique_ptr<drive::CanLink>(std::move(*bus));
  };
  if (drive::is_unix_bus(interface)) return opened(CanHub::open(interface, clock));
  return opened(drive::SocketCanLink::open(interface, SourceId{0}, clock));
}

Result<EStopFile> EStopFile::open(const fs::path& path) {
  std::error_code code;
  if (fs::is_regular_file(path, code)) return EStopFile(path, false);
  if (fs::exists(path, code))
    return Error{Errc::kIo, "the e-stop's line is a file", path.string(), {}, "choose another --estop"};
  if (auto made = write_file_atomic(path, std::string_view("1\n")); !made) return made.error();
  return EStopFile(path, true);
}

EStopFile::~EStopFile() {
  std::error_code ignored;
  if (made_) fs::remove(path_, ignored);
}

bool EStopFile::pressed() const {
  char level = 0;
  return !(std::ifstream(path_) >> level) || level != '1';
}

}  // namespace cairn::simulator
