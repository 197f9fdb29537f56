// Leaves as scene files have them: a thin sheet that lies on other bodies, tied to them by loose tissue, or that is
// held at places: a leaf of peritoneum over fat, a piece of gauze between clips.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/objects/bond_setting.hpp>

namespace trocar::sim {
struct Model;
}

namespace trocar::scene {

struct Context;
struct Description;

struct LeafSetting {
  std::string name, tissue, look;
  std::vector<std::vector<Vec3d>> lines;  ///< that it is spanned over, from one border to the other [m]
  double thickness = 0;                   ///< [m]
  double spacing = 0.003;                 ///< of its nodes [m]
  std::vector<Anchor> held;               ///< centre and radius
  std::vector<std::string> held_on;       ///< solids and strands
  double held_reach = 0.003;              ///< [m]
  std::vector<BondSetting> bonds;
  bool cuttable = true;
  core::Location at;
  JsonValue text;  ///< as it was read
};

/// The kind, as object_scenes.hpp lists it.
struct LeafScene {
  using Setting = LeafSetting;
  static constexpr const char* kKey = "leaves";

  static Key row();  ///< of scene files
  static Setting read(const JsonObject& o, Context& c);
  static JsonValue written(const Setting& setting) { return setting.text; }
  static void bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp);
  /// compile/compile_leaf.cpp
  static void compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                      std::vector<core::Fault>& faults);
};

}  // namespace trocar::scene
