// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/label_recording.hpp"

#include <memory>
#include <type_traits>
#include <utility>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/thermal/thermal.hpp"
#include "hal/clock.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/perception/networks/open_networks.hpp"
#include "tools/cli/label/label_output.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

/// The networks of the profile that exist.
struct OpenNetworks {
  std::unique_ptr<Segmenter> segmenter;
  std::unique_ptr<Detector> detector, thermal_detector;
};

template <class Port, class Open>
Result<void> open_one(const networks::NetworkConfig& config, const std::vector<fs::path>& folders, const char* section,
                      Open open, std::unique_ptr<Port>& port, std::optional<NetworkFigures>& figures,
                      LabelReport& report) {
  if (!config.exists()) return {};
  NetworkFigures made;
  auto opened = open(config, folders, &made.facts);
  if (!opened) {
    Error error = opened.error();
    error.where = std::string("perception.") + section + ": " + error.where;
    return error;
  }
  if (std::string note = made.facts.note(); !note.empty())
    report.notes.push_back(std::string("perception.") + section + ": " + note);
  port = std::move(*opened);
  figures = std::move(made);
  return {};
}

Result<OpenNetworks> open_all(const networks::PerceptionConfig& config, const fs::path& profile, LabelReport& report) {
  OpenNetworks open;
  const auto folders = networks::model_folders(profile);
  if (auto done = open_one(config.segmentation, folders, "segmentation", networks::open_segmenter, open.segmenter,
                           report.segmentation, report);
      !done)
    return done.error();
  if (auto done = open_one(config.detection, folders, "detection", networks::open_detector, open.detector,
                           report.detection, report);
      !done)
    return done.error();
  if (auto done = open_one(config.thermal_detection, folders, "thermal_detection", networks::open_detector,
                           open.thermal_detector, report.thermal_detection, report);
      !done)
    return done.error();
  if (open.segmenter || open.detector || open.thermal_detector) return open;
  return Error{Errc::kInvalidConfig,
               "the profile names no network",
               profile.empty() ? "defaults" : profile.string(),
               {},
               "name one as perception.segmentation.model or perception.detection.model; docs/perception.md shows how"};
}

/// Runs the networks over the pictures that it is given.
class Labelling {
 public:
  Labelling(OpenNetworks networks, LabelOutput output, LabelReport& report)
      : networks_(std::move(networks)), output_(std::move(output)), report_(report) {}

  Result<void> label_colour(const std::string& camera, const Image& picture) {
    ++report_.pictures;
    const LabelImage* labels = nullptr;
    const Detections* found = nullptr;
    if (networks_.segmenter) {
      labels = timed(*report_.segmentation, [&] { return networks_.segmenter->segment(picture); });
      if (labels != nullptr)
        if (auto kept = output_.keep(*labels); !kept) return kept;
    }
    if (networks_.detector) found = detect(*networks_.detector, *report_.detection, camera, picture);
    return output_.keep_overlay(camera, picture, labels, found);
  }

  Result<void> label_thermal(const std::string& camera, const ThermalImage& seen) {
    if (seen.correcting) {  // frozen or wrong
      ++report_.correcting;
      return {};
    }
    const Image& picture = seen.stretched;
    ++report_.pictures;
    const Detections* found = detect(*networks_.thermal_detector, *report_.thermal_detection, camera, picture);
    return output_.keep_overlay(camera, picture, nullptr, found);
  }

  Result<void> finish() { return output_.finish(); }

 private:
  const Detections* detect(Detector& detector, NetworkFigures& figures, const std::string& camera,
                           const Image& picture) {
    const Detections* found = timed(figures, [&] { return detector.detect(picture); });
    if (found != nullptr) output_.keep(camera, *found);
    return found;
  }
  /// The answer of a network; null if there is none.
  template <class Ask>
  auto timed(NetworkFigures& figures, Ask ask) -> std::remove_cvref_t<decltype(*ask())> {
    const Time start = clock_.now();
    const Duration cpu = thread_cpu_time();
    const auto answer = ask();
    if (!answer) {
      if (figures.failed++ == 0) report_.notes.push_back(to_string(answer.error()));
      return nullptr;
    }
    figures.add_time(clock_.now() - start, thread_cpu_time() - cpu);
    figures.add(**answer);
    return *answer;
  }

  OpenNetworks networks_;
  LabelOutput output_;
  LabelReport& report_;
  LiveClock clock_;
};

/// The decoders of the recording's cameras.
struct Cameras {
  camera::Camera colour;
  thermal::Thermal thermal;
  bool side_by_side = false;
  std::optional<std::size_t> colour_source, thermal_source;  // the first of each kind
};

Result<Cameras> cameras_of(const recording::Recording& recording, const app::RobotProfile& profile,
                           LabelReport& report) {
  auto colour = camera::Camera::create(profile.camera.driver);
  if (!colour) return colour.error();
  auto thermal = thermal::Thermal::create(profile.thermal.driver);
  if (!thermal) return thermal.error();
  Cameras cameras{std::move(*colour), std::move(*thermal), profile.camera.driver.side_by_side, {}, {}};
  for (std::size_t i = 0; i < recording.sources.size(); ++i) {
    const auto& entry = recording.sources[i];
    if (entry.kind != recording::kCamera && entry.kind != recording::kThermal) continue;
    auto& source = entry.kind == recording::kCamera ? cameras.colour_source : cameras.thermal_source;
    if (!source)
      source = i;
    else
      report.notes.push_back("not labelled: the source " + entry.id + "; the first of its kind is");
  }
  return cameras;
}

/// Decodes pictures and has them labelled.
class Pictures {
 public:
  Pictures(Cameras cameras, const recording::Recording& recording, const LabelReport& report)
      : cameras_(std::move(cameras)),
        recording_(recording),
        colour_(report.segmentation || report.detection),
        thermal_(report.thermal_detection) {}

  Result<void> take(const Packet& packet, Labelling& labelling) {
    const auto index = static_cast<std::size_t>(packet.source);
    const std::string& id = recording_.sources[index].id;
    if (colour_ && cameras_.colour_source == index) {
      const auto picture = cameras_.colour.decode(packet);
      if (!picture) return at(id, picture.error());
      if (!cameras_.side_by_side) return labelling.label_colour(id, **picture);
      if (auto cut = camera::left_eye(**picture, left_); !cut) return at(id, cut.error());
      return labelling.label_colour(id, left_);
    }
    if (!thermal_ || cameras_.thermal_source != index) return {};
    const auto picture = cameras_.thermal.decode(packet);
    if (!picture) return at(id, picture.error());
    return *picture == nullptr ? Result<void>{} : labelling.label_thermal(id, **picture);
  }

 private:
  Cameras cameras_;
  const recording::Recording& recording_;
  bool colour_, thermal_;
  Image left_;
};

void note_damage(const Error& error, LabelReport& report) {
  if (report.damaged++ < LabelReport::kMaxDamage) report.damage.push_back(to_string(error));
}

/// What is left of the disk decides about writing: an error of the system ends the run, a damaged picture does not.
Result<void> label_all(const LabelOptions& options, recording::RecordingReader& reader, Pictures& pictures,
                       Labelling& labelling, LabelReport& report) {
  for (Packet packet;;) {
    if (options.stop && options.stop()) {
      report.interrupted = true;
      return labelling.finish();
    }
    const auto polled = reader.next(packet, Duration{});
    if (!polled)
      note_damage(polled.error(), report);
    else if (*polled == Poll::kEnd)
      return labelling.finish();
    else if (*polled == Poll::kPacket)
      if (auto taken = pictures.take(packet, labelling); !taken) {
        if (taken.error().code == Errc::kIo) return taken;
        note_damage(taken.error(), report);
      }
  }
}

}  // namespace

Result<LabelReport> label_recording(const LabelOptions& options) {
  auto reader = recording::RecordingReader::open(options.recording);
  if (!reader) return reader.error();
  const auto chosen = app::choose_profile(options.config, options.recording);
  if (!chosen) return chosen.error();
  LabelReport report;
  auto networks = open_all(chosen->profile.perception.networks, chosen->file, report);
  if (!networks) return networks.error();
  const recording::Recording& recording = (*reader)->recording();
  auto cameras = cameras_of(recording, chosen->profile, report);
  if (!cameras) return cameras.error();
  auto output = LabelOutput::create(options.out, options.overlay, options.overwrite);
  if (!output) return output.error();
  Labelling labelling(std::move(*networks), std::move(*output), report);
  Pictures pictures(std::move(*cameras), recording, report);
  if (auto done = label_all(options, **reader, pictures, labelling, report); !done) return done.error();
  if (report.pictures > 0 || report.interrupted) return report;
  return Error{Errc::kNotFound,
               "no picture for the profile's networks is in the recording",
               options.recording.string(),
               {},
               report.damage.empty() ? "segmentation and detection take sources of the kind camera, thermal_detection "
                                       "takes thermal"
                                     : report.damage.front()};
}

}  // namespace cairn::cli
