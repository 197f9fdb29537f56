// What of an instrument bends beyond its trocar: a chain of hinges from the shaft's end to the jaws. A wrist is two of
// them; a flexible section is a row of vertebrae, several of whose hinges share a joint. Frames are those of
// fulcrum.hpp: -z along the shaft, x where jaws open, y across.
//
//   const TipFrame tip = forward(bends, port, pose, joints, jaw_length);
//
// `pose` is that of the straight instrument: depth from the port to where its tip would be with all joints at 0.
//
// A hand leads a wrist joint by joint. What has more joints than two is redundant: the hand leads the tip's frame, and
// the chain follows (reach()).
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/kinematics/fulcrum.hpp>

namespace trocar::kinematics {

inline constexpr int kMaxJoints = 4;   ///< beyond the trocar, without jaws
inline constexpr int kMaxHinges = 12;  ///< several may share a joint
inline constexpr int kMaxLinks = 6;    ///< straight pieces between the shaft's end and the jaws' hinge

/// One hinge of the chain.
struct Hinge {
  double before = 0;        ///< from the hinge before, or the shaft's end, along the chain [m]
  double share = 1;         ///< of the joint's angle
  std::int32_t joint = 0;   ///< whose angle it turns by
  std::int32_t across = 0;  ///< 0: it turns about x, where jaws open (pitch); 1: about y (yaw)

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("before", s.before), v("share", s.share), v("joint", s.joint), v("across", s.across);
  }
};

/// Angles of the joints [rad]; 0 is straight.
struct Joints {
  double angle[kMaxJoints] = {0, 0, 0, 0};

  bool bent() const noexcept {
    for (const double a : angle)
      if (a != 0) return true;
    return false;
  }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("angle", s.angle);
  }
};

/// The chain; without joints the instrument is rigid.
struct Articulation {
  std::int32_t joints = 0, hinges = 0;
  Hinge hinge[kMaxHinges];
  double low[kMaxJoints] = {0, 0, 0, 0}, high[kMaxJoints] = {0, 0, 0, 0};  ///< [rad]
  double after = 0;  ///< from the last hinge to the jaws' hinge [m]

  bool bends() const noexcept { return joints > 0; }
  bool redundant() const noexcept { return joints > 2; }
  double length() const noexcept;  ///< from the shaft's end to the jaws' hinge [m]
  int links() const noexcept;      ///< straight pieces of some length

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("joints", s.joints), v("hinges", s.hinges), v("hinge", s.hinge), v("low", s.low), v("high", s.high),
        v("after", s.after);
  }
};

/// A wrist: the first hinge turns about x, the second, `between` further on, about y; the jaws' hinge comes `after`
/// that. Both turn as far as `most` either way [rad].
Articulation wrist(double between, double after, double most_pitch, double most_yaw) noexcept;

/// Where the chain is in space.
struct Chain {
  TipFrame shaft;             ///< where the shaft ends
  Vec3d bend[kMaxLinks + 1];  ///< ends of the straight pieces: from the shaft's end to the jaws' hinge
  int links = 0;
  TipFrame tip;  ///< of the closed jaws
};
Chain chain(const Articulation& bends, Vec3d port, const FulcrumPose& pose, const Joints& joints,
            double jaw_length) noexcept;
TipFrame forward(const Articulation& bends, Vec3d port, const FulcrumPose& pose, const Joints& joints,
                 double jaw_length) noexcept;

Joints clamped(const Articulation& bends, const Joints& joints) noexcept;

/// The frame that a hand asks of a redundant instrument: the straight instrument's tip, turned about that by pitch and
/// yaw.
TipFrame led(Vec3d port, const FulcrumPose& pose, double pitch, double yaw) noexcept;

/// What is to be reached.
struct Goal {
  Vec3d tip;                           ///< [m]
  Mat3d rotation = Mat3d::identity();  ///< as of TipFrame
  bool turn_too = true;                ///< about the jaws' axis as well; else only that points where it shall
};
/// The chain's coordinates, those of the shaft first.
struct Arm {
  FulcrumPose pose;
  Joints joints;
};
/// `rounds` steps from `arm` towards the goal: damped least squares [Wampler 1986] over the shaft's four coordinates
/// and the joints, weighted so that what stands at a limit rests; what is left over (the null space) goes towards
/// straight joints [Liegeois 1977]. The port is the shaft's fulcrum throughout. A fixed amount of arithmetic, in a
/// fixed order.
Arm reach(const Articulation& bends, const FulcrumLimits& limits, Vec3d port, double jaw_length, const Goal& goal,
          const Arm& arm, int rounds) noexcept;

}  // namespace trocar::kinematics
