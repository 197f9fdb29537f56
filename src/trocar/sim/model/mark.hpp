// A mark: a small disc, or a stripe around a strand, that exercises look for or work at. It is visible and drawn, and
// has no contact.
#pragma once

#include <string>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::sim {

struct Model;
struct State;

/// Const after compile. What lies on a wall is in space: walls do not move.
struct MarkModel {
  std::string name, label, colour, look;  ///< the last three for the picture
  interactions::MaterialPoint at;         ///< a disc's middle; a stripe goes around the rod that this is on
  double s = 0;                           ///< of a stripe, as arc length [m]
  Vec3d place, normal{0, 0, 1};           ///< as drawn: middle [m] and where it faces, unit
  double half = 0.0025;                   ///< radius of a disc, half the width of a stripe [m]
  double high = 0;                        ///< by how much a disc with a look stands out, for the picture [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("s", s.s), v("place", s.place), v("normal", s.normal), v("half", s.half),
        v("name", s.name, core::kNotHashed), v("label", s.label, core::kNotHashed),
        v("colour", s.colour, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("high", s.high, core::kNotHashed);
  }

  bool is_stripe() const noexcept { return at.body.is(BodyKind::strand); }
  bool on_organ() const noexcept { return at.body.is(BodyKind::organ); }
  int body() const noexcept { return at.in_space() ? -1 : int(at.body.index()); }  ///< number among its kind
};

/// Samples by which one sees how much of a mark is in view: of a disc its middle and six points at 0.7 radii, of a
/// stripe three places along the strand.
inline constexpr int kDiscSamples = 7, kStripeSamples = 3;

struct MarkPose {
  Vec3d place;   ///< its middle [m]; of a stripe on the strand's middle line
  Vec3d normal;  ///< where it faces, unit; of a stripe the strand's direction
};
MarkPose pose_of(const Model& model, const State& state, const MarkModel& mark) noexcept;

/// Sample `k` of the mark [m]; of a stripe on the side towards the eye.
Vec3d mark_sample(const Model& model, const State& state, const MarkModel& mark, int k, Vec3d eye) noexcept;

}  // namespace trocar::sim
