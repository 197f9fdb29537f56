#include "commands/gallery/gallery_names.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/two_eyes.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::app {
namespace {

// Of any scene; in the order in which they are drawn.
constexpr const char* kOfAnyScene[] = {"endoscope",
                                       "exchange before",
                                       "exchange at the trocar",
                                       "exchange in again",
                                       "exchanged",
                                       "height 25 mm above an organ",
                                       "height 8 mm above an organ",
                                       "height touching an organ",
                                       "clips",
                                       "cut",
                                       "coagulation",
                                       "fogged lens",
                                       "burn",
                                       "wiping the lens",
                                       "wiped lens",
                                       "bleeding jet",
                                       "bleeding film",
                                       "bleeding endoscope",
                                       "bleeding pool",
                                       "analysis strain,forces",
                                       "analysis springs",
                                       "analysis pressure",
                                       "organs as edges",
                                       "organs transparent",
                                       "tubes transparent",
                                       "folds hidden",
                                       "organs"};

}  // namespace

std::vector<std::string> gallery_names(const scene::Description& scene) {
  std::vector<std::string> names(std::begin(kOfAnyScene), std::end(kOfAnyScene));
  for (const pictures::StereoName& n : pictures::kStereoNames)
    if (n.mode && n.mode != render::StereoMode::quad_buffer) names.push_back(fmt::format("two eyes {}", n.name));
  for (const pictures::CameraPreset& preset : pictures::kCameraPresets) names.emplace_back(preset.name);
  for (const scene::Instrument& instrument : scene.instruments) names.push_back(instrument.name);
  for (const scene::Solid& organ : scene.solids) {
    names.push_back(organ.name);
    if (!organ.cuttable) continue;
    for (const char* what : {"between blades", "cut", "cut endoscope"}) names.push_back(organ.name + " " + what);
  }
  for (const scene::Strand& tube : scene.strands) {
    if (!tube.fimbriated) continue;
    for (const char* what : {"look-alikes", "fold", "fimbria"}) names.push_back(tube.name + " " + what);
  }
  return names;
}

void check_picture_name(const std::string& part, const std::vector<scene::Description>& scenes) {
  std::vector<std::string> known;
  for (const scene::Description& scene : scenes)
    for (std::string& name : gallery_names(scene)) known.push_back(std::move(name));
  const auto has_it = [&part](const std::string& name) { return name.find(part) != std::string::npos; };
  if (std::any_of(known.begin(), known.end(), has_it)) return;
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw core::BadInput({{{"--only", 0, 0}, scene::unknown_name("part of a picture's name", part, known)}});
}

}  // namespace trocar::app
