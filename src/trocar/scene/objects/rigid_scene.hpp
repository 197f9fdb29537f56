// Rigid objects as scene files have them: rings, chains of beads, pebbles.
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

struct RigidSetting {
  std::string name, look;
  double outer = 0;          ///< a ring's outer diameter [m]; 0: a chain
  std::vector<Vec3d> chain;  ///< middles of its thick line, in its own frame [m]
  Vec3d pebble;              ///< diameters of a pebble along its own axes, the widest first [m]; zero: none
  double thick = 0;          ///< diameter of what it is made of [m]
  double mass = 0;           ///< [kg]
  double friction = 0.3;     ///< Coulomb's coefficient
  Vec3d place;               ///< of its middle [m]
  Vec3d axis{0, 0, 1};       ///< of a ring; of others: where its z points
  std::string pouch;         ///< what it lies in; empty: it lies free
  core::Location at;
  JsonValue text;  ///< as it was read
};

/// The kind, as object_scenes.hpp lists it.
struct RigidScene {
  using Setting = RigidSetting;
  static constexpr const char* kKey = "rigids";

  static Key row();  ///< of scene files
  static Setting read(const JsonObject& o);
  static JsonValue written(const Setting& setting) { return setting.text; }
  /// Pebbles lie where the anatomy leaves room for them; the rest is no part of it.
  static void bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp);
  static void compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                      std::vector<core::Fault>& faults);
};

}  // namespace trocar::scene
