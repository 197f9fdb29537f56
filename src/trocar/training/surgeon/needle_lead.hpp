// How a hand that holds a needle has to stand for the needle to stand as it shall. An instrument through a trocar turns
// about its shaft alone, so that the needle comes as near to it as that allows.
#pragma once

#include <trocar/interactions/objects/suture.hpp>
#include <trocar/training/surgeon/surgeon.hpp>

namespace trocar::training {

/// A needle's middle and how it is turned.
struct NeedlePose {
  Vec3d x;
  Quatd q;
};
inline NeedlePose pose_of(const suture::NeedleState& s) { return {s.x, s.q}; }

/// The circle that a needle is to be driven along: tip first from `in` to `out`, about `axis`, with the bend's middle
/// above both.
struct NeedleWay {
  Vec3d centre, axis, in;
  double angle = 0;  ///< between in and out, seen from the centre [rad]

  /// With the tip at that angle beyond `in`.
  NeedlePose at(const suture::NeedleModel& m, double angle) const;
};
/// @param up    out of the tissue
/// @param port  of the hand's instrument: the axis is along its shaft, as far as in and out let it
NeedleWay way_between(const suture::NeedleModel& m, Vec3d in, Vec3d out, Vec3d up, Vec3d port);

/// Where the hand's tip and roll are wanted for that pose, by how the needle lies in its jaws now.
struct HandWish {
  Vec3d tip;
  double roll = 0;
};
HandWish wish_for(const Surgeon& op, int hand, const NeedlePose& pose);
/// The same where one place of the needle, `arc` from its tip, shall be exactly where that pose has it: whatever the
/// shaft cannot turn is then off elsewhere.
HandWish wish_for(const Surgeon& op, int hand, const NeedlePose& pose, double arc);

/// One tick towards it. True when it is there.
bool lead_needle(Surgeon& op, int hand, const NeedlePose& pose, double speed);
bool lead_needle(Surgeon& op, int hand, const NeedlePose& pose, double speed, double arc);

}  // namespace trocar::training
