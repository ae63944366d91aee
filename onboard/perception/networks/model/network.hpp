// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/image.hpp"
#include "hal/result.hpp"
#include "onboard/perception/networks/config/network_config.hpp"

namespace cairn::networks {

/// What one output of a network holds after a run. The numbers are the network's and stay valid until its next run.
struct Output {
  std::vector<std::int64_t> shape;
  std::span<const float> values;  ///< row by row, the last dimension first
};

/// Where the picture lies in the network's input: a pixel (x, y) of the picture is at (x · scale_x, y · scale_y).
struct Placement {
  int input_width = 0, input_height = 0;      ///< pixels
  int picture_width = 0, picture_height = 0;  ///< pixels
  double scale_x = 1, scale_y = 1;
};

/// What is known of a network once it is open.
struct NetworkFacts {
  std::filesystem::path file;
  std::string sha256;    ///< of the file
  bool checked = false;  ///< the profile names that sum
  std::int64_t opset = 0;
  int input_width = 0, input_height = 0;  ///< pixels
  std::string output;                     ///< its shape, such as 1x20x512x1024

  /// What a user should know of a network that is not checked; empty: nothing.
  [[nodiscard]] std::string note() const;
};

/// A network in OpenCV's DNN module: pictures in, numbers out. One thread, on the CPU. With the same machine, model and
/// picture the numbers are the same; across machines OpenCV does not promise it.
class Network {
 public:
  /// Reads and checks the model and runs it once, on a picture of zeros. Errors: those of read_model();
  /// kInvalidConfig: the model's input is another one than `config` says; kUnsupported: OpenCV cannot read or run it.
  [[nodiscard]] static Result<Network> load(const NetworkConfig& config,
                                            std::span<const std::filesystem::path> folders);
  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  ~Network();

  /// Runs the network on a picture of the format kBgr8 or kMono8 and of any size. Errors: kUnsupported (another format,
  /// an empty picture), kIo (OpenCV failed).
  [[nodiscard]] Result<void> run(const ImageView& picture);
  [[nodiscard]] std::span<const Output> outputs() const;
  /// Of the last run's picture.
  [[nodiscard]] const Placement& placement() const;
  [[nodiscard]] const NetworkFacts& facts() const;

 private:
  struct Parts;
  explicit Network(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::networks
