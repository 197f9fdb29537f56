// Needles and threads move, pierce and go through tissue: after bodies have advanced.
//
// A tip that presses on skin dimples it until its force reaches the tissue's puncture force; then there is a hole, and
// the tip is inside. It cuts its way against a part of that force, leaving a hole each millimetre of its path; it comes
// out where it meets the skin again from inside, and pierces it there. Holes that the swage has passed are the
// thread's: a few of each bite, as the thread's own friction makes up for the others.
#pragma once

#include <array>

#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

inline constexpr double kAcrossWire = 200;     ///< per millimetre of track [N/m]; per area: times 1/mm. Our estimate
inline constexpr double kTipStiffness = 1000;  ///< of skin under a tip [N/m]
inline constexpr double kThreadHole = 1000;    ///< of a hole about the thread [N/m]
inline constexpr double kPricks = 0.25;        ///< cosine between tip and skin's normal above which it can pierce
inline constexpr double kTipAhead = 0.0001;    ///< [m] from which on a skin counts as touched
inline constexpr double kTipLeaves = 0.0006;   ///< [m] from which on it does not any more
inline constexpr double kRoomAtPinch = 0.003;  ///< [m] of thread beside what is between jaws that these do not push

inline Vec3d vector_of(const std::array<float, 3>& a) noexcept { return {double(a[0]), double(a[1]), double(a[2])}; }
inline std::array<float, 3> array_of(Vec3d v) noexcept { return {float(v.x), float(v.y), float(v.z)}; }

/// Does that part of the needle, or of the thread, lie in the body, by the holes that it goes through?
bool goes_through(const SutureModel& m, const SutureState& s, BodyId body, double arc, bool needle) noexcept;

/// A stitch that was torn out of a body.
struct TornStitch {
  BodyId body, suture;
  Vec3d at;         ///< the hole that was cut out [m]
  double pull = 0;  ///< of the thread there [N]
};
/// A thread that was pulled apart, or crushed between instruments.
struct BrokenThread {
  BodyId suture;
  std::int32_t crushed_by = -1;  ///< a hand; -1: it was pulled apart
};
inline constexpr int kMostSewn = 8;  ///< stitches, and threads, that a tick reports

/// What happened in a tick.
struct SewnReport {
  BodyId bad;  ///< a suture that is not finite any more
  std::array<TornStitch, kMostSewn> torn;
  std::array<BrokenThread, kMostSewn> broken;
  std::int32_t torn_count = 0, broken_count = 0;
  bool records_full = false;  ///< no room for another hole or bite: the needle does not go in
  bool events_lost = false;   ///< more than kMostSewn

  void add(const TornStitch& stitch) noexcept {
    events_lost = events_lost || torn_count == kMostSewn;
    if (torn_count < kMostSewn) torn[size_t(torn_count++)] = stitch;
  }
  void add(const BrokenThread& thread) noexcept {
    events_lost = events_lost || broken_count == kMostSewn;
    if (broken_count < kMostSewn) broken[size_t(broken_count++)] = thread;
  }
};
SewnReport sew(const SutureModels& models, const Bodies& bodies, Vec3d gravity, double dt, const tissue::Box& cavity,
               Suture::States& states, SutureWorks& work) noexcept;

/// Jaws turn on a needle that is twisted in them with more than they bear, and follow a thread that slips through them.
/// @param tool  the State of that hand's instrument, which holds a suture
void slip_in_jaws(const SutureModels& models, const Suture::States& states, const SutureWorks& work, int hand,
                  const ToolModel& model, const ToolShape& shape, ToolState& tool) noexcept;

}  // namespace trocar::interactions
