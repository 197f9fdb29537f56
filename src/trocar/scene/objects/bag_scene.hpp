// Retrieval bags as scene files have them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::sim {
struct Model;
}

namespace trocar::scene {

struct Description;

struct BagSetting {
  std::string name, look;
  double mouth = 0.060;   ///< diameter of its open hoop [m]
  double deep = 0.110;    ///< [m]
  double weight = 0.004;  ///< of the cloth [kg]
  core::Location at;
  JsonValue text;  ///< as it was read
};

/// The kind, as object_scenes.hpp lists it.
struct BagScene {
  using Setting = BagSetting;
  static constexpr const char* kKey = "bags";

  static Key row();  ///< of scene files
  static Setting read(const JsonObject& o);
  static JsonValue written(const Setting& setting) { return setting.text; }
  static void bend(std::vector<Setting>&, const std::function<Vec3d(Vec3d)>&) {}  ///< no part of the anatomy
  static void compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                      std::vector<core::Fault>& faults);
  /// Once hands are known: one of them has to be able to bring it in.
  static void expect_hand(const std::vector<Setting>& settings, const sim::Model& model,
                          std::vector<core::Fault>& faults);
};

}  // namespace trocar::scene
