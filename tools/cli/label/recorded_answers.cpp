// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/recorded_answers.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "hal/files/file.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"
#include "onboard/perception/networks/recorded/label_picture.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using report::Json;

constexpr std::size_t kMostPictures = 200'000;  // of one folder that are looked at

/// In the order of their names, so that faults come in the same order on every machine.
std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && files.size() < kMostPictures;
       at.increment(error))
    if (at->path().extension() == ".png") files.push_back(at->path());
  std::ranges::sort(files);
  return files;
}

/// What all pictures of labels have in common.
struct LabelFigures {
  std::uint64_t pictures = 0, pixels = 0, probability_sum = 0;
  std::set<std::pair<int, int>> sizes;
  std::array<std::uint64_t, 256> of_class{};

  void add(const LabelImage& labels) {
    ++pictures;
    pixels += labels.classes.size();
    sizes.emplace(labels.width, labels.height);
    for (const std::uint8_t id : labels.classes) ++of_class[id];
    for (const std::uint8_t p : labels.probabilities) probability_sum += p;
  }
  [[nodiscard]] Json to_json() const {
    Json json{
        {"pictures", pictures}, {"sizes", Json::array()}, {"share", Json::object()}, {"mean_probability", nullptr}};
    for (const auto& [width, height] : sizes)
      json["sizes"].push_back(std::to_string(width) + "x" + std::to_string(height));
    if (pixels == 0) return json;
    const auto total = static_cast<double>(pixels);
    for (std::size_t id = 0; id < kSemanticClasses.size(); ++id)
      if (of_class[id] > 0)
        json["share"][std::string(kSemanticClasses[id].name)] = static_cast<double>(of_class[id]) / total;
    if (of_class[kNoClass] > 0) json["share"]["none"] = static_cast<double>(of_class[kNoClass]) / total;
    json["mean_probability"] = static_cast<double>(probability_sum) / 255.0 / total;
    return json;
  }
};

}  // namespace

Json describe_labels(const fs::path& recording, std::vector<std::string>& damage) {
  const fs::path folder = recording / networks::kLabelFolder;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return nullptr;
  LabelFigures figures;
  LabelImage labels;
  for (const fs::path& path : pictures_in(folder)) {
    const auto file = read_file(path, networks::kMaxLabelFileBytes);
    const auto decoded = file ? networks::decode_label_picture(*file, labels) : Result<void>(file.error());
    if (decoded)
      figures.add(labels);
    else
      damage.push_back(to_string(at(path.string(), decoded.error())));
  }
  return figures.to_json();
}

Json describe_boxes(const fs::path& recording, std::vector<std::string>& damage) {
  const fs::path path = recording / networks::kBoxFile;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return nullptr;
  const auto bytes = read_file(path, networks::kMaxBoxFileBytes);
  std::vector<networks::RecordedBoxes> pictures;
  const auto parsed = bytes ? networks::parse_boxes({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                                                    path.string(), pictures)
                            : Result<void>(bytes.error());
  if (!parsed) damage.push_back(to_string(parsed.error()));
  std::map<std::string, std::uint64_t> cameras, classes;
  for (const auto& picture : pictures) {
    ++cameras[picture.camera];
    for (const Detection& d : picture.found) ++classes[std::string(kSemanticClasses[d.class_id].name)];
  }
  return {{"pictures", cameras}, {"boxes", classes}};
}

}  // namespace cairn::cli
