// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/network.hpp"

#include <exception>
#include <mutex>
#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <utility>

#include "onboard/perception/networks/model/input_tensor.hpp"
#include "onboard/perception/networks/model/model_file.hpp"

namespace cairn::networks {
namespace {

constexpr std::int64_t kMaxInputSide = 4096;
// What OpenCV 4.6 was made for; it reads much of later ones, too.
constexpr std::int64_t kOldestOpset = 7, kNewestOpset = 12;

/// OpenCV's state is the process's. Its errors come back as results, so that it need not print them as well.
void prepare_opencv() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::setNumThreads(1);
    cv::ocl::setUseOpenCL(false);
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  });
}

std::string input_text(int planes, std::int64_t width, std::int64_t height) {
  const std::int64_t shape[] = {1, planes, height, width};
  return shape_text(shape);
}

struct Size {
  int width = 0, height = 0;
};

/// The size that the network is run with: the profile's, or the model's own.
Result<Size> input_size(const NetworkConfig& config, const OnnxTensor& input) {
  const int planes = input_planes(config);
  const auto refuse = [&](const std::string& remedy) {
    const std::string expected = input_text(planes, config.input_width, config.input_height);
    return Error{Errc::kInvalidConfig,
                 "the model's input is another one than the profile says",
                 {},
                 {},
                 "expected " + expected + ", found " + shape_text(input.shape) + " (" + input.name + "); " + remedy};
  };
  if (input.shape.size() != 4) return refuse("a network takes batch x planes x height x width");
  if (input.shape[0] > 1) return refuse("export the model for one picture at a time");
  if (input.shape[1] > 0 && input.shape[1] != planes)
    return refuse("set `channels`: grey is one plane, bgr and rgb are three");
  const std::int64_t width = config.input_width > 0 ? config.input_width : input.shape[3];
  const std::int64_t height = config.input_height > 0 ? config.input_height : input.shape[2];
  if (width == 0 || height == 0) return refuse("set input_width and input_height: the model leaves them open");
  if (width > kMaxInputSide || height > kMaxInputSide) return refuse("a side has at most 4096 pixels");
  return Size{static_cast<int>(width), static_cast<int>(height)};
}

/// What OpenCV says, without the place in its sources.
std::string reason(const std::exception& e) {
  const auto* cv_error = dynamic_cast<const cv::Exception*>(&e);
  std::string text = cv_error != nullptr ? cv_error->err : e.what();
  // Models hold any bytes as names.
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
  return text.substr(0, 300);
}

Error cannot_use(std::string_view cause, const ModelFile& model, const std::exception& e) {
  std::string detail = reason(e) + "; ";
  if (model.header.opset < kOldestOpset || model.header.opset > kNewestOpset)
    detail += "it has opset " + std::to_string(model.header.opset) + ", OpenCV reads opsets " +
              std::to_string(kOldestOpset) + " to " + std::to_string(kNewestOpset) + " best: ";
  detail += "export it again with opset 11 or 12 and without operators that OpenCV " CV_VERSION " lacks";
  return {Errc::kUnsupported, cause, model.path.string(), {}, std::move(detail)};
}

std::vector<std::int64_t> shape_of(const cv::Mat& values) { return {values.size.p, values.size.p + values.dims}; }

}  // namespace

struct Network::Parts {
  Parts(const cv::dnn::Net& n, InputTensor i, NetworkFacts f) : net(n), input(std::move(i)), facts(std::move(f)) {
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    names = net.getUnconnectedOutLayersNames();
  }
  void forward(const ImageView& picture) {
    input.fill(picture);
    net.setInput(input.blob());
    net.forward(results, names);
    outputs.clear();
    for (const cv::Mat& result : results) {
      if (result.type() != CV_32F || !result.isContinuous())
        CV_Error(cv::Error::StsUnsupportedFormat, "an output is not of 32-bit numbers");
      outputs.push_back({shape_of(result), {result.ptr<float>(), result.total()}});
    }
  }

  cv::dnn::Net net;
  InputTensor input;
  NetworkFacts facts;
  std::vector<cv::String> names;
  std::vector<cv::Mat> results;
  std::vector<Output> outputs;
};

Network::Network(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;
Network::~Network() = default;
std::span<const Output> Network::outputs() const { return parts_->outputs; }
const Placement& Network::placement() const { return parts_->input.placement(); }
const NetworkFacts& Network::facts() const { return parts_->facts; }

std::string NetworkFacts::note() const {
  if (checked) return {};
  return file.string() + " is not checked: put `sha256: " + sha256 + "` beside `model` in the profile";
}

Result<Network> Network::load(const NetworkConfig& config, std::span<const std::filesystem::path> folders) {
  prepare_opencv();
  if (auto sound = check(config); !sound) return sound.error();
  const auto model = read_model(config.model, config.sha256, folders);
  if (!model) return model.error();
  const auto size = input_size(config, model->header.inputs.front());
  if (!size) return at(model->path.string(), size.error());
  NetworkFacts facts{.file = model->path,
                     .sha256 = model->sha256,
                     .checked = !config.sha256.empty(),
                     .opset = model->header.opset,
                     .input_width = size->width,
                     .input_height = size->height,
                     .output = {}};
  try {
    cv::dnn::Net net =
        cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(model->bytes.data()), model->bytes.size());
    Network network(std::make_unique<Parts>(std::move(net), InputTensor(config, size->width, size->height), facts));
    const std::byte black[3]{};
    network.parts_->forward({PixelFormat::kBgr8, 1, 1, sizeof black, black});
    for (const Output& output : network.outputs()) {
      std::string& text = network.parts_->facts.output;
      text += (text.empty() ? "" : " and ") + shape_text(output.shape);
    }
    return network;
  } catch (const std::exception& e) {
    return cannot_use("OpenCV cannot run the model", *model, e);
  }
}

Result<void> Network::run(const ImageView& picture) {
  if (picture.format != PixelFormat::kBgr8 && picture.format != PixelFormat::kMono8)
    return Error{Errc::kUnsupported, "a network takes colour or grey pictures with 8 bits"};
  if (picture.empty()) return Error{Errc::kUnsupported, "a network takes no empty picture"};
  try {
    parts_->forward(picture);
    return {};
  } catch (const std::exception& e) {
    return Error{Errc::kIo, "OpenCV failed on this picture", parts_->facts.file.string(), {}, reason(e)};
  }
}

}  // namespace cairn::networks
