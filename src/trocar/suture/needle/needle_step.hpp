// What acts on a needle in a tick, and the tick: one implicit Euler step for six velocities. Whatever touches, holds or
// embeds a needle is a spring with a dashpot along a direction, which may only push, or may bear no more than a bound
// (friction, cutting); the secant of a spring at its bound takes its place until the forces agree [Baraff & Witkin
// 1998]. Springs of any stiffness are stable, so that 68 mg of steel can hang on jaws and on tissue at once.
//
//   clear(work);
//   work.contacts.push_back(...);   // beads near surfaces
//   work.holds.push_back(...);      // jaws
//   work.pins.push_back(...);       // places of tissue that it goes through
//   advance(model, gravity, tick, state, work);
//
// A needle in tissue goes freely along its arc, against a bounded drag; across it every pin is a spring, so that the
// force grows with the area that the wire sweeps beside its path. [Jackson & Çavuşoğlu 2012]
#pragma once

#include <vector>

#include <trocar/suture/needle/needle.hpp>

namespace trocar::suture {

/// A bead near a surface.
struct NeedleContact {
  std::int32_t bead = 0;
  Vec3d normal;             ///< from the surface to the needle, unit
  double gap = 0;           ///< between both surfaces [m]
  Vec3d velocity{0, 0, 0};  ///< of the surface [m/s]
  double stiffness = 0;     ///< [N/m]
  double friction = 0;      ///< Coulomb's coefficient
  std::int32_t owner = -1;  ///< the caller's
  Vec3d force{0, 0, 0};     ///< out: on the needle [N]
};
/// A place of the wire that is pulled to a point. Those of one owner, one after the other, pull together with no more
/// than it bears.                                                                                     [needle in jaws]
struct NeedleHold {
  Vec3d own, target;  ///< [m] own frame; the scene's
  double stiffness = 0, damping = 0;
  std::int32_t owner = -1;
  Vec3d force{0, 0, 0};  ///< out: on the needle [N]
  double bears = -1;     ///< of all of the owner's [N]; below 0: whatever comes
  bool slips = false;    ///< out: they bear no more, the wire slides there
};
/// A place of tissue that the wire goes through.
struct NeedlePin {
  Vec3d point, velocity{0, 0, 0};  ///< [m], [m/s]
  double across = 0;               ///< stiffness across the wire [N/m]
  double drag = 0;                 ///< most along the wire [N]
  double stuck = 0;                ///< in, out: strain of that friction along the wire, towards the tip [m]
  double arc = 0;                  ///< out: where on the wire it is [m]
  std::int32_t owner = -1;
  Vec3d force{0, 0, 0};  ///< out: on the needle [N]
};
/// Resistance to the tip: against what it has not entered yet, or what it cuts.
struct NeedleTip {
  bool there = false;
  Vec3d dir;                ///< along which it keeps the tip back, unit: the force on the needle is along dir
  double gap = 0;           ///< how far the tip has gone against dir; `cuts`: in, out: strain of what it cuts [m]
  Vec3d velocity{0, 0, 0};  ///< of what it meets [m/s]
  double stiffness = 0;     ///< [N/m]
  double most = -1;         ///< that it bears [N]; below 0: whatever comes
  double friction = 0;      ///< across dir
  Vec3d slid{0, 0, 0};      ///< in, out: strain of that friction [m]
  Vec3d force{0, 0, 0};     ///< out: on the needle [N]
};
/// What the thread does at the swage: the force that it pulls with where that is now, and by how much that falls where
/// the swage goes along it.
struct NeedleTail {
  Vec3d force{0, 0, 0};  ///< [N]
  double stiffness = 0;  ///< along the force [N/m]
};

/// Along one direction, as the solver has it.
struct NeedleSpring {
  /// `grips`: threes along the axes, one after the other, whose force together is bounded.
  enum Bound : std::int32_t { both, push, most, rubs, grips };
  std::array<double, 6> row{};  ///< dot motion: the speed along it
  double stiffness = 0, damping = 0, gap = 0, drive = 0;
  double bears = 0;  ///< `most`, `grips`: [N]; `rubs`: coefficient
  Bound bound = both;
  std::int32_t normal = -1;  ///< `rubs`: number of the spring that presses; `grips`: of the first of those
  double share = 1, force = 0;
};

struct NeedleWork {
  std::vector<NeedleContact> contacts;
  std::vector<NeedleHold> holds;
  std::vector<NeedlePin> pins;
  NeedleTip tip;   ///< what it has not entered
  NeedleTip cuts;  ///< what it cuts
  NeedleTail tail;
  std::vector<NeedleSpring> springs;
  bool overflowed = false;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("contacts", s.contacts), v("holds", s.holds), v("pins", s.pins), v("tip", s.tip), v("cuts", s.cuts),
        v("tail", s.tail), v("springs", s.springs), v("overflowed", s.overflowed);
  }
};

inline constexpr int kMostContacts = 2 * kMostBeads, kMostNeedleHolds = 48, kMostPins = 64;
NeedleWork make_needle_work();
void clear(NeedleWork& work) noexcept;
template <class T>
void add(std::vector<T>& list, const T& item, NeedleWork& work) noexcept {
  if (list.size() == list.capacity())
    work.overflowed = true;
  else
    list.push_back(item);
}

/// One tick. What was out of bounds for what hands do (3 m/s, 300 rad/s) is held to that.
/// @return whether all of it is finite
bool advance(const NeedleModel& model, Vec3d gravity, double tick, NeedleState& state, NeedleWork& work) noexcept;

}  // namespace trocar::suture
