// Slings: a suture that an instrument of the kind "endoloop" brings in as a loop of thread at the mouth of its tube.
// Its beginning ends in a knot that the rest of the thread runs through, back into the tube: drawing the thread in
// closes the loop, and the knot lets it slip in that sense easily, in the other one not until much pulls at it.
//
//   s = 0 the knot, 0 .. knot the loop, knot .. fed the tail from the knot to the mouth, from fed on in the tube
//
// Of the thread in the tube nothing is computed: its elements sleep (the thread takes them to be parted) and lie along
// the tube's axis. Until the loop is open, and while the instrument is hardly in the body, all of it is carried
// along as it lies by itself (suture_sling_shape.hpp). What a loop does to the strand that it lies around:
// suture_strangle.hpp; what moves it: suture_sling_step.hpp. docs/guides/endoloop.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::interactions {

/// What there is of it beside its thread; without a loop the suture is no sling.
struct SlingModel {
  double loop = 0;                ///< thread in the open loop [m]
  double stowed = 0;              ///< and in the loop that is carried in [m]
  double slides = 1, slips = 11;  ///< of the knot: closing, and opening again [N]
  std::int32_t first_hold = 0;    ///< the thread's slots of its own: kSlingHolds from here on

  bool there() const noexcept { return loop > 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("loop", s.loop), v("stowed", s.stowed), v("slides", s.slides), v("slips", s.slips), v("first_hold", s.first_hold);
  }
};

/// Holds of a sling's thread: its knot at the mouth, the thread in the mouth, and the first node in the tube.
enum SlingHold : std::int32_t { kKnotHold, kMouthHold, kFeedHold, kSlingHolds };

/// A strand that the loop lies around. No padding.
struct SlingAround {
  MaterialPoint at;  ///< where the loop's surface meets the strand's middle line
  std::int32_t reserved = 0;
  double radius = 0;    ///< within the loop, when it is drawn round: thread around / 2 pi less half its thickness [m]
  double squeeze = 0;   ///< mean depth of the thread in the strand [m]
  double press = 0;     ///< of thread on strand, all around [N]
  double cutting = 0;   ///< for how long it has been pulled at with more than the strand bears [s]
  Vec3d pull{0, 0, 0};  ///< of the thread on the strand in the last tick [N]
  double stiff = 0;     ///< of what presses there [N/m]
  double bears = 8;     ///< tension of the loop that cuts through it [N]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("reserved", s.reserved), v("radius", s.radius), v("squeeze", s.squeeze), v("press", s.press),
        v("cutting", s.cutting), v("pull", s.pull), v("stiff", s.stiff), v("bears", s.bears);
  }
};
inline constexpr int kMostAround = 3;

/// Where the tube ends. No padding.
struct SlingMouth {
  Vec3d tip;             ///< [m]
  Vec3d axis{0, 0, -1};  ///< out of the tube, unit
  Vec3d up{0, 1, 0};     ///< in the loop's plane, across the axis, unit

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("tip", s.tip), v("axis", s.axis), v("up", s.up);
  }
};

struct SlingState {
  enum Stage : std::int32_t {
    packed,   ///< no hand has it
    stowed,   ///< a hand has it; as it was laid
    opening,  ///< thread is fed out until the loop is as large as it is made; it stands as it is bent by itself
    open,     ///< the knot is at the mouth
    off,      ///< the knot has left the mouth, thread runs from it to the mouth
    left,     ///< it was cut off: the loop stays where it is, with its knot
  };
  std::int32_t stage = packed;
  std::int32_t hand = -1;    ///< that has it, or had
  std::int32_t parted = -1;  ///< left: the element that was cut
  std::int32_t around_count = 0;
  std::int32_t was_closed = 0;  ///< in the last tick: 1 it closed a lumen, 2 it had sunk in
  std::int32_t last = -1;       ///< the strand that it lay around last
  double knot = 0, fed = 0;     ///< arc lengths of the thread: in the knot, in the mouth [m]
  double tension = 0;           ///< of the loop beside the knot [N]
  double tail = 0;              ///< between knot and mouth [N]
  double pulled = 0;            ///< out of the tube, by all of the thread, in the last tick [N]
  SlingMouth mouth;
  std::array<SlingAround, kMostAround> around{};

  bool out() const noexcept { return stage >= opening && stage != left; }  ///< of the tube, and on the instrument
  bool computed() const noexcept { return stage > opening; }
  /// Or is not there any more.
  bool lies_in_tube(double s) const noexcept { return stage <= stowed || s > fed; }
  bool lies_around(BodyId strand) const noexcept {
    for (std::int32_t i = 0; i < around_count; ++i)
      if (around[std::size_t(i)].at.body == strand) return true;
    return false;
  }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("stage", s.stage), v("hand", s.hand), v("parted", s.parted), v("around_count", s.around_count),
        v("was_closed", s.was_closed), v("knot", s.knot), v("fed", s.fed), v("tension", s.tension), v("tail", s.tail),
        v("pulled", s.pulled), v("mouth", s.mouth), v("around", s.around), v("last", s.last);
  }
};

/// The instrument that has it, in this tick.
struct SlingHand {
  std::int32_t hand = -1;  ///< -1: none
  SlingMouth mouth;
  double depth = 0;  ///< of the tube's end in the body [m]
  double drawn = 0;  ///< how far the rod draws the thread's clamp back: 0 the handle open .. 1 closed
  double most = 0;   ///< tension that the rod can put on the thread now [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("hand", s.hand), v("mouth", s.mouth), v("depth", s.depth), v("drawn", s.drawn), v("most", s.most);
  }
};

/// Scratch of a tick.
struct SlingWork {
  SlingHand hand;
  Vec3d force{0, 0, 0};             ///< out: of the thread on the instrument [N]
  std::vector<std::int32_t> on;     ///< (nodes) which of `around` it presses on; -1: none
  std::vector<double> stiff, deep;  ///< (nodes) with [N/m]; how deep in it [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("hand", s.hand), v("force", s.force), v("on", s.on), v("stiff", s.stiff), v("deep", s.deep);
  }
};

}  // namespace trocar::interactions
