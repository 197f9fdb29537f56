// Fat as scene files have it: thick lines that it fills, as far as nothing else is there, and what it holds on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/tissue/fat/fat.hpp>

namespace trocar::sim {
struct Model;
}

namespace trocar::scene {

struct Description;

struct FatSetting {
  struct Fill {
    std::vector<Vec3d> line;  ///< middles of a thick line [m]
    double radius = 0;        ///< [m]
  };
  /// Lobules within it are drawn as one thing of that look: a lymph node.
  struct Nodule {
    Fill in;
    std::string look;
  };
  std::string name, look;
  std::vector<Fill> fills;
  std::vector<Nodule> nodules;
  std::vector<std::string> on;  ///< strands, organs and pouches
  double reach = 0.003;         ///< [m]
  double spacing = 0.0025;      ///< of lobules [m]
  double toughness = 15;        ///< of what holds it on others [J/m^2]
  double opens = 0.004;         ///< [m]
  tissue::FatMaterial material;
  core::Location at;
  JsonValue text;  ///< as it was read
};

/// The kind, as object_scenes.hpp lists it.
struct FatScene {
  using Setting = FatSetting;
  static constexpr const char* kKey = "fat";

  static Key row();  ///< of scene files
  static Setting read(const JsonObject& o);
  static JsonValue written(const Setting& setting) { return setting.text; }
  static void bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp);
  static void compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                      std::vector<core::Fault>& faults);
};

}  // namespace trocar::scene
