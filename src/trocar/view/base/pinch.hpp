// Where clips and closed jaws press drawn tissue flat. The simulation knows a tube as a line with a radius; its picture
// must not stick out through the metal that holds it.
#pragma once

#include <span>
#include <vector>

#include <trocar/sim/model/clip_seat.hpp>

namespace trocar::view {

/// Two parallel legs of a clip around a tube.
struct ClipPress {
  Vec3d centre, open, axis, normal;  ///< of the tube between the legs; unit directions, normal = axis x open
  double flat = 0.3;                 ///< radius share that is left across the legs
  double radius = 0;                 ///< of the tube [m]
  double low = 0, high = 0;          ///< legs from and to, along the axis from the centre [m]
  double s = 0;                      ///< where on its strand [m]
  double stump[2] = {0, 0};          ///< way to a cut end against and along the normal [m]; 0: there is none near
};

/// A loop of thread that has sunk in around a tube.
struct LoopPress {
  Vec3d centre, along;            ///< of the tube there
  double within = 0, radius = 0;  ///< radius within the loop; of the tube [m]
  double half = 0;                ///< of the thread's thickness [m]
  double s = 0;                   ///< where on its strand [m]
};

/// Closed jaws that hold something.
struct JawPress {
  interactions::ToolShape shape;
  double length = 0, half_width = 0;  ///< of the jaws [m]
};

using sim::kClipHalfGap, sim::kClipLegWidth, sim::kClipLegThickness, sim::kClipLength;
/// A cut end that is no further from a clip is closed by it: it cannot open to a round tube again [m].
inline constexpr double kSealedWithin = 0.008;

/// Does that clip close a cut end of its strand there, at arc length `end` [m]?
bool closes_end(const interactions::Clip& clip, double end);
ClipPress press_of(const interactions::Clip& clip, const sim::Model& model, const sim::State& state);
/// Of a clip that sits on a thread, `number` in the buffer; radius 0: it has detached.
ClipPress press_on_thread(const interactions::Clip& clip, int number, const sim::State& state);
/// Clips on a strand.
std::vector<ClipPress> clips_on(int strand, const sim::Model& model, const sim::State& state);
/// Jaws that hold that body.
std::vector<JawPress> jaws_on(BodyId body, const sim::Model& model, const sim::State& state);

/// Loops that have sunk into a strand.
std::vector<LoopPress> loops_on(int strand, const sim::Model& model, const sim::State& state);

Vec3d pressed(Vec3d p, const ClipPress& press);
Vec3d pressed(Vec3d p, const LoopPress& press);
Vec3d pressed(Vec3d p, const JawPress& press);

}  // namespace trocar::view
