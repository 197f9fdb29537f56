// Sutures as scene files have them: a thread by size and make, a needle by name, where they lie or who holds them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/objects/sling_scene.hpp>

namespace trocar::sim {
struct Model;
}

namespace trocar::scene {

struct Description;

struct SutureSetting {
  std::string name, look, needle_look;
  std::string size, make;   ///< of the thread; empty: there is none
  double length = 0.15;     ///< of the thread [m]
  std::string needle;       ///< kind; empty: there is none
  Vec3d place;              ///< of the needle's centre of mass [m]
  Vec3d axis{0, 0, 1};      ///< about which a turn drives it, tip first
  Vec3d points{1, 0, 0};    ///< the way its tip drives, as far as that is across the axis
  std::vector<Vec3d> line;  ///< of the thread, from the swage on [m]
  std::string hand;         ///< trocar of the hand that holds the needle; empty: it lies
  bool backhand = false;
  double grasped = 0.65;  ///< where, of its length from the tip
  SlingSetting sling;
  core::Location at;
  JsonValue text;  ///< as it was read
};

/// A needle's own axes to the scene's: z about `axis`, y, the way its middle is driven, as near to `points` as can be.
Quatd needle_turn(Vec3d axis, Vec3d points);

/// The kind, as object_scenes.hpp lists it. What needs all bodies and hands is added later
/// (compile/compile_hands.hpp).
struct SutureScene {
  using Setting = SutureSetting;
  static constexpr const char* kKey = "sutures";

  static Key row();  ///< of scene files
  static Setting read(const JsonObject& o);
  static JsonValue written(const Setting& setting) { return setting.text; }
  static void bend(std::vector<Setting>&, const std::function<Vec3d(Vec3d)>&) {}  ///< no part of the anatomy
  static void compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                      std::vector<core::Fault>& faults);
};

}  // namespace trocar::scene
