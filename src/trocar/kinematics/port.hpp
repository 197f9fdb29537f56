// A trocar that gives: its fulcrum is held by an abdominal wall, which yields to what the shaft presses across itself,
// and it wanders in the course of an operation.
//
//   state = moved(model, state, on_wall, pose, outside, tick, dt);  // where the fulcrum is beside its place
//   const FulcrumPose is = about_shifted(pose, state.shift, outside);
//
// A hand holds a handle. It leads an instrument by `pose`, which is that about the fulcrum's place; where the fulcrum
// has moved, the handle is where it was, and the shaft goes from there through the fulcrum: an instrument of length L
// that is d deep has its tip beside by 1 + d/(L - d) of what the fulcrum moved.
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/kinematics/fulcrum.hpp>

namespace trocar::kinematics {

struct PortModel {
  double stiffness = 0;  ///< across the shaft; 0: rigid [N/m]
  double drift = 0;      ///< how far it wanders at most [m]
  std::uint64_t seed = 0;
  Vec3d across[2] = {{1, 0, 0}, {0, 1, 0}};  ///< the plane in which it wanders, unit

  bool moves() const noexcept { return stiffness > 0 || drift > 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("stiffness", s.stiffness), v("drift", s.drift), v("seed", s.seed), v("across", s.across);
  }
};

struct PortState {
  Vec3d give{0, 0, 0};   ///< by what presses on it [m]
  Vec3d shift{0, 0, 0};  ///< of the fulcrum from its place: that and where it has wandered [m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("give", s.give), v("shift", s.shift);
  }
};

inline constexpr double kMostGive = 0.015;      ///< [m] what an abdominal wall lets a trocar go; our choice
inline constexpr double kLeastOutside = 0.050;  ///< [m] of an instrument that is pushed in to its handle

/// Where it has wandered after `seconds`: from its place to a place at random in a disc of radius `drift`, and on to
/// the next, twenty seconds each, at rest in each. A function of seed and time; never outside the disc.
Vec3d drift_of(const PortModel& model, double seconds) noexcept;

/// The pose about the shifted fulcrum of an instrument whose handle is where `pose` about the unshifted one has it.
/// @param outside  from the fulcrum to the handle [m]
FulcrumPose about_shifted(const FulcrumPose& pose, Vec3d shift, double outside) noexcept;

/// After dt: the wall follows a force as a spring with a damper, 50 ms or longer where the hand's lever magnifies what
/// the fulcrum does at the tip; so tissue up to 10 N/mm at the tip and the wall come to rest with each other.
/// @param on_wall  of the instrument on the wall, across the shaft [N]
PortState moved(const PortModel& model, const PortState& state, Vec3d on_wall, const FulcrumPose& pose, double outside,
                double seconds, double dt) noexcept;

}  // namespace trocar::kinematics
