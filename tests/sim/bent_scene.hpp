// The small scene with a grasper that bends, and scissors laid across a link of it: what only the link meets.
//
//   small::Bent bent;                  // the grasper bent by 0.9 rad, the scissors' shaft beside its link
//   bent.straighten();                 // then nothing meets
#pragma once

#include <trocar/scene/mechanisms/mechanism_file.hpp>

#include "small_scene.hpp"

namespace trocar::small {

/// The small scene, its grasper with a wrist, or with four vertebrae and a wrist.
inline sim::Model bending(bool flexible) {
  scene::Description d = description();
  for (scene::Instrument& i : d.instruments) {
    if (i.name != "grasper") continue;
    i.jaw_length = 0.012;
    i.wrist.there = true;
    i.wrist.between = 0.02;
    if (!flexible) continue;
    i.wrist.mechanism.file = "flexible_instrument.json";
    i.wrist.mechanism.description = std::make_shared<const kinematics::MechanismDescription>(
        scene::read_mechanism(TROCAR_SOURCE_DIR "/scenes/mechanisms/flexible_instrument.json"));
  }
  return scene::compile(d);
}
inline const sim::Model& wristed() {
  static const sim::Model model = bending(false);
  return model;
}

struct Bent {
  const sim::Model& model = wristed();
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);

  /// @param gap  between the link and the scissors' shaft [m]
  explicit Bent(double gap = 0.003) {
    interactions::ToolState& held = state.tools[kGrasper];
    held.depth = 0.085;
    held.yaw = -0.5;  // beside all tissue
    held.aperture = 0;
    state.joints[kGrasper].angle[0] = 0.9;
    lay_scissors(gap);
  }
  void straighten() { state.joints[kGrasper] = {}; }

  interactions::ToolShape grasper() const { return sim::shape_of(model, state, kGrasper); }
  Vec3d middle() const {
    const interactions::Capsule& link = grasper().link[0];
    return 0.5 * (link.a + link.b);
  }
  /// Unit, square to the link, to the side on which the straight instrument is not.
  Vec3d beside() const {
    const interactions::ToolShape s = grasper();
    const Vec3d link = s.link[0].b - s.link[0].a;
    return normalised(cross(link, cross(s.shaft.axis(), link)) * -1.0);
  }
  /// Their shaft goes past the middle of the link, on its far side.
  void lay_scissors(double gap) {
    const interactions::ToolModel& scissors = model.placed(kScissors);
    const Vec3d port = model.hands[kScissors].port;
    const Vec3d at = middle() + (gap + scissors.shaft_radius + model.placed(kGrasper).shaft_radius) * beside();
    const kinematics::FulcrumPose pose = kinematics::inverse(port, at + 0.04 * normalised(at - port), 0);
    interactions::ToolState& s = state.tools[kScissors];
    s.yaw = pose.yaw, s.pitch = pose.pitch, s.roll = pose.roll, s.depth = pose.depth;
    s.aperture = 0;
  }
};

}  // namespace trocar::small
