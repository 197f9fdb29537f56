// A clip on a thread, or on several stretches of it: a bead that friction holds, which ties what lies between its legs
// together. Between neighbouring stretches it is a bar that keeps them as far apart as they were; they turn about it
// freely. It neither goes through a point of tissue (a passage) nor through what holds the thread: there it is a stop.
// Its weight is lumped at the places that it holds.
#pragma once

#include <array>
#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

inline constexpr int kMostThreadClips = 16, kMostClipped = 4;  ///< on one thread; stretches of it between a clip's legs
inline constexpr double kClipHolds = 4;             ///< of each stretch, by friction [N].                          [d]
inline constexpr double kClipMass = 7e-5;           ///< titanium: two legs of 8.5 mm and 0.9 mm^2 [kg].            [c]
inline constexpr double kClipHalfWidth = 0.00055;   ///< of its legs, along the thread [m]
inline constexpr double kHolderHalfWidth = 0.0015;  ///< of jaws that hold the thread, there [m].                   [d]

/// No padding.
struct ThreadClip {
  std::int32_t count = 0;                ///< stretches between its legs
  std::int32_t number = -1;              ///< by which its setter knows it
  std::array<double, kMostClipped> s{};  ///< where it has them, in their order along its legs [m]
  std::array<double, kMostClipped - 1> apart{},
      reached{};          ///< of a stretch and the next [m]; strain of the bar as in Rub
  Vec3d axis, open, bar;  ///< of its legs, and to the last stretch: in the thread's frame at s[0] when it was set
  Vec3d at, axis_now, open_now;  ///< its place between the legs and its pose, as they are seen [m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("count", s.count), v("number", s.number), v("s", s.s), v("apart", s.apart), v("reached", s.reached),
        v("axis", s.axis), v("open", s.open), v("bar", s.bar), v("at", s.at), v("axis_now", s.axis_now),
        v("open_now", s.open_now);
  }
};
static_assert(sizeof(ThreadClip) == 2 * 4 + 10 * 8 + 6 * 24, "no padding");

}  // namespace trocar::suture
