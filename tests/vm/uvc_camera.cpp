// SPDX-License-Identifier: Apache-2.0
// A UVC camera without hardware: it speaks USB/IP over a socket pair to the kernel's vhci-hcd, so that the real
// uvcvideo driver reads real descriptors and receives real payloads. Bulk transfers; see uvc_frames.hpp for its
// pictures.
//   uvc_camera plug      attaches it to the first port and stays in the background until it is unplugged
//   uvc_camera unplug    pulls it out, whatever it is doing
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "hal/clock.hpp"
#include "tests/vm/uvc_descriptors.hpp"
#include "tests/vm/uvc_frames.hpp"

namespace cairn::vm {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Setup = std::array<std::uint8_t, 8>;  // a control transfer: type, request, value, index, length

// The header of every USB/IP message: ten big-endian words and, in a submission, the setup packet.
struct Header {
  std::array<std::uint32_t, 10> words;
  Setup setup;
};
static_assert(sizeof(Header) == 48);
enum Word { kCommand = 0, kSequence = 1, kDirection = 3, kEndpoint = 4, kStatus = 5, kUnlinked = 5, kLength = 6 };
enum Command : std::uint32_t { kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinkDone = 4 };

std::uint32_t big_endian(std::uint32_t value) { return __builtin_bswap32(value); }

// The kernel's end of the cable. It is closed when the camera is unplugged, and with it this program ends.
class Cable {
 public:
  explicit Cable(int fd) : fd_(fd) {}

  void read(void* to, std::size_t n) const {
    move(static_cast<char*>(to), n, [this](char* at, std::size_t k) { return ::read(fd_, at, k); });
  }
  void write(const void* from, std::size_t n) const {
    move(static_cast<const char*>(from), n,
         [this](const char* at, std::size_t k) { return ::send(fd_, at, k, MSG_NOSIGNAL); });
  }
  // True when there is something to read within `wait`; forever where that is negative.
  [[nodiscard]] bool wait(int milliseconds) const {
    pollfd p{fd_, POLLIN, 0};
    return poll(&p, 1, milliseconds) > 0;
  }

 private:
  template <class Pointer, class Transfer>
  static void move(Pointer at, std::size_t n, Transfer transfer) {
    while (n > 0) {
      const ssize_t k = transfer(at, n);
      if (k < 0 && errno == EINTR) continue;
      if (k <= 0) std::exit(0);
      at += k;
      n -= static_cast<std::size_t>(k);
    }
  }
  int fd_;
};

class Camera {
 public:
  Camera(const Cable& cable, const Clock& clock) : cable_(cable), clock_(clock) {}

  void run() {
    for (;;) {
      send_frames();
      if (cable_.wait(milliseconds_to_next_frame())) answer();
    }
  }

 private:
  struct Request {
    std::uint32_t sequence;
    std::size_t length;
  };
  static constexpr std::size_t kProbeLength = 26;  // UVC 1.0's
  static constexpr std::size_t kPayloadHeader = 2;

  [[nodiscard]] std::size_t mode_index() const { return std::clamp<std::size_t>(probe_[2], 1, kModes.size()) - 1; }
  [[nodiscard]] int milliseconds_to_next_frame() const {
    if (!streaming_ || requests_.empty()) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next_ - clock_.now()).count();
    return static_cast<int>(std::clamp<long>(left, 0, 1000));
  }

  void reply(std::uint32_t sequence, int status, std::span<const std::uint8_t> data, std::size_t length) const {
    Header header{};
    header.words[kCommand] = big_endian(kSubmitted);
    header.words[kSequence] = big_endian(sequence);
    header.words[kStatus] = big_endian(static_cast<std::uint32_t>(status));
    header.words[kLength] = big_endian(static_cast<std::uint32_t>(length));
    header.words[8] = ~0U;  // no isochronous packets
    cable_.write(&header, sizeof header);
    cable_.write(data.data(), data.size());
  }

  // A frame goes out in pieces, one for each waiting request, when its time has come.
  void send_frames() {
    while (streaming_ && !requests_.empty()) {
      if (sent_ >= payload_.size()) {
        const Time now = clock_.now();
        if (now < next_) return;
        next_ = std::max(next_ + std::chrono::nanoseconds(100LL * kModes[mode_index()].interval), now);
        start_frame();
      }
      const Request request = requests_.front();
      requests_.pop_front();
      const std::size_t n = std::min(request.length, payload_.size() - sent_);
      reply(request.sequence, 0, std::span(payload_).subspan(sent_, n), n);
      sent_ += n;
    }
  }
  void start_frame() {
    const Bytes frame = make_frame(kModes[mode_index()], number_);
    payload_.assign(
        {kPayloadHeader, static_cast<std::uint8_t>(0x82U | (number_ & 1U))});  // end of frame, and its parity
    payload_.insert(payload_.end(), frame.begin(), frame.end());
    sent_ = 0;
    ++number_;
  }
  void stream(bool on) {
    streaming_ = on;
    payload_.clear();
    sent_ = 0;
    next_ = clock_.now();
  }

  void answer() {
    Header header{};
    cable_.read(&header, sizeof header);
    for (auto& word : header.words) word = big_endian(word);
    if (header.words[kCommand] == kUnlink) return unlink(header);
    const bool in = header.words[kDirection] == 1;
    const std::size_t length = header.words[kLength];
    Bytes out(in ? 0 : length);
    cable_.read(out.data(), out.size());
    const std::uint32_t sequence = header.words[kSequence];
    if (header.words[kEndpoint] != 0) {
      requests_.push_back({sequence, length});
      return;
    }
    auto data = control(header.setup, out);
    if (!data) return reply(sequence, -EPIPE, {}, 0);  // a stall: the camera has no such thing
    if (!in) return reply(sequence, 0, {}, length);
    data->resize(std::min(data->size(), length));
    reply(sequence, 0, *data, data->size());
  }

  void unlink(const Header& asked) {
    const auto at = std::find_if(requests_.begin(), requests_.end(),
                                 [&](const Request& r) { return r.sequence == asked.words[kUnlinked]; });
    Header header{};
    header.words[kCommand] = big_endian(kUnlinkDone);
    header.words[kSequence] = big_endian(asked.words[kSequence]);
    if (at != requests_.end()) {
      requests_.erase(at);
      header.words[kStatus] = big_endian(static_cast<std::uint32_t>(-ECONNRESET));
    }
    cable_.write(&header, sizeof header);
  }

  // What a control transfer returns; nothing for a stall.
  std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> out) {
    const auto value = static_cast<std::uint16_t>(setup[2] | setup[3] << 8);
    switch (setup[0] << 8 | setup[1]) {
      case 0x8006:
        return descriptor(value);
      case 0x8000:
      case 0x8100:
      case 0x8200:
        return Bytes{0, 0};  // GET_STATUS
      case 0x0009:           // SET_CONFIGURATION
      case 0x010b:           // SET_INTERFACE
      case 0x0201:           // CLEAR_FEATURE(HALT): this is how the driver stops a bulk stream
        stream(false);
        return Bytes{};
      default:
        break;
    }
    const bool commit = value >> 8 == 2;
    if (setup[4] != 1 || (!commit && value >> 8 != 1))
      return std::nullopt;  // not the streaming interface's probe or commit
    return negotiate(setup, commit, out);
  }
  std::optional<Bytes> negotiate(const Setup& setup, bool commit, std::span<const std::uint8_t> out) {
    if (setup[0] == 0x21 && setup[1] == 1) {  // SET_CUR
      std::copy_n(out.begin(), std::min(out.size(), kProbeLength), probe_.begin());
      complete_probe();
      if (commit) stream(true);
      return Bytes{};
    }
    if (setup[0] != 0xa1) return std::nullopt;
    if (setup[1] == 0x86) return Bytes{3};                // GET_INFO: can be read and set
    if (setup[1] == 0x85) return Bytes{kProbeLength, 0};  // GET_LEN
    complete_probe();
    return Bytes(probe_.begin(), probe_.end());
  }
  // The format is the host's choice, the rest follows from it.
  void complete_probe() {
    const Mode& mode = kModes[mode_index()];
    const std::uint32_t payload = mode.max_bytes + kPayloadHeader;
    probe_[2] = static_cast<std::uint8_t>(mode_index() + 1);
    probe_[3] = 1;
    std::memcpy(&probe_[4], &mode.interval, 4);
    std::memcpy(&probe_[18], &mode.max_bytes, 4);
    std::memcpy(&probe_[22], &payload, 4);
  }

  const Cable& cable_;
  const Clock& clock_;
  std::array<std::uint8_t, kProbeLength> probe_{};
  std::deque<Request> requests_;
  Bytes payload_;
  std::size_t sent_ = 0;
  bool streaming_ = false;
  std::uint32_t number_ = 0;
  Time next_{};
};

// Writes a line into one of vhci-hcd's files.
bool tell_vhci(std::string_view file, std::string_view line) {
  const std::string path = "/sys/devices/platform/vhci_hcd.0/" + std::string(file);
  std::ofstream out(path);
  out << line << std::flush;
  if (!out) std::fprintf(stderr, "uvc_camera: %s: %s\n", path.c_str(), std::strerror(errno));
  return out.good();
}

int plug() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return 1;
  // port, socket, device id (bus 1, device 1), high speed
  if (!tell_vhci("attach", "0 " + std::to_string(ends[1]) + " 65537 3")) return 1;
  close(ends[1]);
  if (daemon(0, 0) != 0) return 1;
  const Cable cable(ends[0]);
  const LiveClock clock;
  Camera(cable, clock).run();
  return 0;
}

}  // namespace
}  // namespace cairn::vm

int main(int argc, char** argv) {
  const std::string_view what = argc == 2 ? argv[1] : "";
  if (what == "plug") return cairn::vm::plug();
  if (what == "unplug") return cairn::vm::tell_vhci("detach", "0") ? 0 : 1;
  std::fputs("usage: uvc_camera plug|unplug\n", stderr);
  return 2;
}
