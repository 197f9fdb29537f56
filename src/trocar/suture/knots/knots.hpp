// What knots a thread has been tied in, read from where it lies. It only judges: nothing of it goes back into the step.
//
//   const KnotReading knot = read_knot(points, {.split = s});   // both sides of the tissue that the thread goes
//   through if (knot.kind == KnotKind::square) ...
//
// A thread that goes through tissue has two sides, and a throw twists them: once round each other they cross three
// times, with n turns 2 n + 1 times, all with one sign. Throws of opposite signs lie square, of equal signs they make a
// granny [Adams 2004: sums of (2, 2 n + 1) torus knots]. The crossings are those of a picture of the thread, from the
// side from which there are fewest, without those that come undone by themselves; where one side is straight and only
// the other one turns, throws are half hitches and slip [Patil 2020].
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

inline constexpr int kMostThrows = 8;

/// One throw: how often the sides turn round each other, and which way.
struct KnotThrow {
  std::int32_t turns = 0;  ///< whole turns, 1: single, 2: surgeon's
  std::int32_t sign = 0;   ///< +1: right-handed
  double s = 0, t = 0;     ///< where on the one side and on the other, arc lengths [m]
  Vec3d place;             ///< [m]
};
enum class KnotKind : std::int32_t { none, half, square, granny, slip };
const char* name_of(KnotKind kind) noexcept;

struct KnotReading {
  KnotKind kind = KnotKind::none;
  std::array<KnotThrow, kMostThrows> throws{};  ///< the one nearest to the tissue first
  std::int32_t count = 0;
  std::int32_t crossings = 0;     ///< that are left
  double determinant = 1;         ///< of the thread's knot, whatever pictures tell
  double agree = 0;               ///< share of pictures that tell the same, with that determinant; 0: none has it
  Vec3d place;                    ///< of the first throw [m]
  double tail = 0, standing = 0;  ///< what is left of either side beyond the last throw: of lower s, of higher s [m]
};

struct KnotQuestion {
  double spacing = 0;  ///< of the points along the thread [m]; 0: as they lie
  double split = -1;   ///< arc length in the tissue [m]; below 0: in the middle of the widest loop
  double apart = 0;    ///< further apart than this, elements are not tied to each other [m]; 0: whatever the distance
};
/// @param points  of the thread's middle line
KnotReading read_knot(std::span<const Vec3d> points, const KnotQuestion& question = {});

/// What a thread is tied in, from readings in a row. One that lies tight may show nothing but pictures of other knots;
/// but what it is tied in stays while the determinant does, and is best told from when it lay loosely. A throw is laid
/// upon those that are there, and comes undone before them: a reading that keeps these is believed at once, another
/// only when it is sure or told again and again.
class KnownKnot {
 public:
  /// Throws as told, since the knot last changed, by the reading in which most pictures agreed; place and ends as of
  /// the last one.
  const KnotReading& update(const KnotReading& seen) noexcept;
  const KnotReading& knot() const noexcept { return m_knot; }

 private:
  /// The knot has changed, and into this.
  bool convinces(const KnotReading& seen) noexcept;

  KnotReading m_knot, m_doubted;
  int m_told = 0;  ///< m_doubted, by so many readings in a row
};

/// How often a thread's stretch winds round a segment, signed: right-handed about a -> b is positive.
double turns_around(std::span<const Vec3d> points, Vec3d a, Vec3d b, double reach) noexcept;

}  // namespace trocar::suture
