// What an instrument remembers of the tissue that it touches: where it was in the last tick, which points of which
// bodies were near, and where they stick to it. All of it is State.
//
// Memory serves two things. *Nothing passes through*: a vertex of an organ's skin is pushed back to the side from which
// the instrument came, however deep it has sunk in. *Friction*: Coulomb's, bound by friction times the normal force,
// which is averaged over the last few ticks. What sticks is held by a spring from the tissue's point to an anchor on
// the instrument [Cundall & Strack 1979], which pulls with the bound when it is 0.2 mm long; where it would be longer,
// the tissue slips: the anchor is dragged along, and beyond 10 mm/s a dashpot as strong as the bound at the speed of
// the slip takes the spring's place. The bound is a constant within a tick, spring and dashpot are implicit, so
// friction can only take energy.
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/interactions/instrument/tool.hpp>

namespace trocar::interactions {

inline constexpr int kMaxTouches = 256;    ///< of one instrument
inline constexpr double kGrazes = 0.0001;  ///< apart by less than this [m] friction is not over: contacts may bounce
inline constexpr double kQuickestPush = 0.0012;  ///< [m] a tick that contacts move tissue beyond the instrument's way

/// One point of a body near one part of an instrument. No padding.
struct Touch {
  BodyId body;                  ///< or a wall
  std::int32_t element = 0;     ///< skin vertex, strand element, triangle of a sheet; balls of jaws: below 0
  std::int32_t part = 0;        ///< of the instrument
  std::int32_t vertex = -1;     ///< balls: of the skin, where they were nearest
  std::int32_t anchored = 0;    ///< 1: the rest is known
  float force = 0;              ///< normal force, averaged over the last ticks [N]
  float weight[2] = {0, 0};     ///< the tissue's point within the element: of its second and third corner
  float anchor[3] = {0, 0, 0};  ///< where that point sticks, in the part's frame [m]
  float normal[3] = {0, 0, 0};  ///< this tick's, from the instrument to the tissue

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("element", s.element), v("part", s.part), v("vertex", s.vertex), v("anchored", s.anchored),
        v("force", s.force), v("weight", s.weight), v("anchor", s.anchor), v("normal", s.normal);
  }
};
static_assert(sizeof(Touch) == 14 * 4, "no padding");

/// Of one hand's instrument. Entries beyond `count` are not State.
struct TouchBook {
  double yaw = 0, pitch = 0, roll = 0, depth = 0, aperture = 1;  ///< where it was when it last touched
  kinematics::Joints joints;
  Vec3d shift{0, 0, 0};  ///< of its trocar's fulcrum then [m]
  std::int32_t count = 0, reserved = 0;
  Touch touch[kMaxTouches];  ///< ascending in body, element, part

  const Touch* find(BodyId body, std::int32_t element, std::int32_t part) const noexcept;
  bool near(BodyId body, std::int32_t element) const noexcept;  ///< any part

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("yaw", s.yaw), v("pitch", s.pitch), v("roll", s.roll), v("depth", s.depth), v("aperture", s.aperture),
        v("count", s.count), v("touch", s.touch, core::FieldNote{.first = s.count, .each = true}),
        v("joints", s.joints, core::only_if(s.joints.bent())),
        v("shift", s.shift, core::only_if(dot(s.shift, s.shift) > 0)), v("reserved", s.reserved, core::kNotHashed);
  }
};

/// An instrument that has not moved and touches nothing.
void start_here(const ToolState& tool, const kinematics::Joints& joints, TouchBook& book,
                Vec3d shift = {0, 0, 0}) noexcept;

/// Where the tissue of a touch that is anchored sticks to the instrument [m], and the force of the instrument on the
/// tissue there: along the normal only, averaged over some ten ticks [N].
Vec3d place_of(const ToolShape& shape, const Touch& touch) noexcept;
Vec3d press_of(const Touch& touch) noexcept;

/// Where it was then.
ToolShape shape_before(const ToolModel& model, const TouchBook& book) noexcept;

/// What friction asks of a contact: a spring to `to` from the tissue's point where it sticks; a dashpot along `dir`
/// where it slips.
struct Rub {
  enum Kind : std::int32_t { free, sticks, slips } kind = free;
  Vec3d to{0, 0, 0};          ///< across the normal [m]
  double stiffness = 0;       ///< [N/m]
  Vec3d dir{0, 0, 0};         ///< unit
  double damping = 0;         ///< [N s/m]
  double speed = 0;           ///< of the instrument's surface along dir [m/s]
  double weight[2] = {0, 0};  ///< the tissue's point within its element
};

/// A point of the tissue that touches.
struct Contact {
  Vec3d normal;  ///< unit, from the instrument to the tissue
  Vec3d point, velocity;
  double weight[2] = {0, 0};  ///< of the point within its element
};

/// One instrument in one tick: from where it was to where it is, what it remembers and what it will.
class Touching {
 public:
  /// @param friction  Coulomb's coefficient
  /// @param before    where it was in the last tick
  /// @param last      of the last tick; @param next  scratch, filled again
  Touching(double friction, const ToolShape& before, const ToolShape& shape, int tool, const TouchBook& last,
           TouchBook& next) noexcept;

  const ToolShape& shape;
  const ToolShape& before;
  const int tool;
  const TouchBook& last;
  TouchBook& next;

  double way(int part) const noexcept { return m_way[part]; }  ///< that a part has moved [m]

  /// Notes that a point is near; a number for reactions' tags, 0 where the book is full.
  std::int32_t note(BodyId body, std::int32_t element, std::int32_t part, std::int32_t vertex = -1) noexcept;

  /// A noted point touches: is it to be held back across the normal?
  /// @param number    of the note
  /// @param anchored  where the tissue's point with the weights that were anchored is now
  Rub rub(std::int32_t number, const Contact& contact, Vec3d anchored) noexcept;
  /// The anchored weights of a point, if it was touched in the last tick.
  const Touch* anchored(BodyId body, std::int32_t element, std::int32_t part) const noexcept;

 private:
  double m_friction;
  double m_way[kMostParts];
};

/// Normal force of this tick for the note of that number.
void press_on(TouchBook& next, std::int32_t number, Vec3d force_on_tissue) noexcept;

/// After the tick: what is to be remembered.
void remember(const ToolState& tool, const kinematics::Joints& joints, TouchBook& next, TouchBook& book,
              Vec3d shift = {0, 0, 0}) noexcept;

void add_to_hash(core::Hasher& hasher, const TouchBook& book) noexcept;

}  // namespace trocar::interactions
