// Rigid bodies that are no tissue: rings for peg transfer, stones, and what else is brought in, moved and put down.
// Each is a handful of beads, balls of one radius, which touch walls, tissue, instruments and each other.
//
//   Rigid::clear(work);                                        // each tick
//   Rigid::touch(models, states, hand, work);                  // for each instrument
//   rest_on_skin(models, states, surface, loads, work);        // for each organ (rigid_on_skin.hpp)
//   Rigid::pull(models, states, hold, target, law, tag, work); // for each held point
//   const tissue::StepReport r = Rigid::advance(models, gravity, tick, states, work);
//
// A tick is one implicit Euler step for velocities [Baraff & Witkin 1998]: held points are springs, contacts are
// inequalities with Coulomb's friction that projected Gauss-Seidel solves [Moreau 1999; Catto 2005], inelastic. A
// contact is there before beads touch and lets them come as near as they may, so nothing has to be pushed out again
// and no energy comes of it. What has lain still for a while sleeps: it costs nothing and stays where it is to the bit,
// until an instrument or another body moves beside it or a hand pulls at it. Turns are quaternions; gyroscopic torque
// is implicit, so it only ever takes energy.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/objects/object_hand.hpp>
#include <trocar/interactions/objects/wall_grid.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/base/report.hpp>

namespace trocar::interactions {

struct RigidModel {
  std::string name, look;
  double mass = 0;           ///< [kg]
  Mat3d inertia{};           ///< about its middle, in its own frame [kg m^2]
  double radius = 0;         ///< of a bead [m]
  double reach = 0;          ///< of the farthest bead's surface from its middle [m]
  double friction = 0;       ///< Coulomb's coefficient
  bool closed = false;       ///< the last bead's neighbour is the first
  std::int32_t inside = -1;  ///< the membrane that it lies in at the start; -1: none
  Vec3d pebble{0, 0, 0};     ///< of a pebble: half its diameters along its axes [m]; zero: a ring or a line
  std::vector<Vec3d> beads;  ///< middles, from its own [m]
  std::vector<Vec3d> grips;  ///< places of its surface that jaws hold [m]
  Vec3d place;               ///< of its middle, as placed [m]
  Quatd turn;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed), v("mass", s.mass),
        v("inertia", s.inertia), v("radius", s.radius), v("reach", s.reach), v("friction", s.friction),
        v("closed", s.closed), v("pebble", s.pebble, core::only_if(s.pebble.x > 0)), v("beads", s.beads),
        v("grips", s.grips), v("place", s.place), v("turn", s.turn),
        v("inside", s.inside, core::only_if(s.inside >= 0));
  }
};
struct RigidModels {
  std::vector<RigidModel> list;
  WallGrid walls;  ///< those of the Model once more

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list), v("walls", s.walls, core::kNotHashed);
  }
};

/// No padding.
struct RigidState {
  Vec3d x;           ///< its middle [m]
  Quatd q;           ///< its own axes -> the scene's
  Vec3d v, w;        ///< [m/s], [rad/s] about the scene's axes
  double still = 0;  ///< for how long it has lain still; it sleeps then until something comes near that moves [s]

  /// `still` below 0: it lies in a pouch, moves with that and meets nothing.
  bool inside() const noexcept { return still < 0; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("q", s.q), v("v", s.v), v("w", s.w), v("still", s.still);
  }
};
static_assert(sizeof(RigidState) == 14 * sizeof(double), "no padding");

/// Where a place of its own frame is.
inline Vec3d place_of(const RigidState& s, Vec3d own) noexcept { return s.x + rotate(s.q, own); }

using Vec6 = std::array<double, 6>;  ///< a motion or a wrench: straight, then turning
using Mat6 = std::array<Vec6, 6>;

/// A spring of a hand on a place of the surface.
struct RigidHold {
  std::int32_t body = 0;
  Vec3d arm, target;  ///< from the middle; where it is pulled to [m]
  HoldLaw law;
  Tag tag;
  Vec3d force{0, 0, 0};  ///< on the body, mean of the tick [N]
};
/// A bead near a wall, an instrument or another bead.
struct RigidContact {
  std::int32_t body = 0, other = -1;  ///< other: -1 a wall or an instrument
  Vec3d normal, along, across;        ///< towards the body, unit
  Vec3d arm, other_arm;               ///< of the touching point from the middles [m]
  double gap = 0;                     ///< [m]
  double friction = 0;
  double give = 0;         ///< of what yields, 1 / (its stiffness tick^2) [1/kg]; 0: it is hard
  Vec3d drive{0, 0, 0};    ///< of the other surface across the normal [m/s]
  Vec3d impulse{0, 0, 0};  ///< along normal, along, across [N s]
  Tag tag;
  std::array<Vec6, 3> row, other_row;        ///< dot motion: the speed along each
  std::array<Vec6, 3> answer, other_answer;  ///< the motion that a unit impulse gives
  Vec3d gain;                                ///< along the three, of both [1/kg]
};
/// A rod of an instrument, where it was and where it is.
struct RigidRod {
  collision::Capsule before, now;
  Tag tag;
  BodyId held;  ///< what its jaws hold, which it does not touch
};
/// A bead in tissue that yields.
struct RigidBed {
  std::int32_t body = 0, bead = 0;
  Vec3d normal, velocity;  ///< of the skin there; [m/s]
  double gap = 0;          ///< that the bead gives, the skin gives the rest [m]
};
struct RigidWork {
  std::vector<RigidHold> holds;
  std::vector<RigidRod> rods;
  std::vector<RigidBed> beds;
  std::vector<RigidContact> contacts;
  std::vector<Mat6> mobility;       ///< (bodies)
  std::vector<Vec6> motion;         ///< (bodies)
  std::vector<std::uint8_t> awake;  ///< (bodies)
  bool overflowed = false;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("holds", s.holds), v("rods", s.rods), v("beds", s.beds), v("contacts", s.contacts), v("mobility", s.mobility),
        v("motion", s.motion), v("awake", s.awake), v("overflowed", s.overflowed);
  }
};

/// The kind, as object_kinds.hpp lists it.
struct Rigid {
  static constexpr BodyKind kKind = BodyKind::rigid;
  static constexpr bool kIsTissue = false;
  static constexpr bool kRigidInJaws = true;  ///< it keeps its shape between jaws, and lies where it is put down
  using Models = RigidModels;
  using States = std::vector<RigidState>;
  using Work = RigidWork;

  template <class All>
  static auto& part(All& all) noexcept {
    return all.rigid;
  }
  static int count(const Models& m) noexcept { return int(m.list.size()); }
  static const std::string& name(const Models& m, size_t i) noexcept { return m.list[i].name; }
  static const std::string& look(const Models& m, size_t i) noexcept { return m.list[i].look; }
  static int grip_point_count(const Models& m, size_t i) noexcept { return int(m.list[i].grips.size()); }

  static States start(const Models& models);
  static Work make_work(const Models& models, int hands);

  static void clear(Work& work) noexcept;
  /// An instrument near them.
  static void touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept;
  /// Places between jaws: add(place, where in the jaw frame).
  template <class Add>
  static void between(const Models& models, const States& states, size_t i, const ToolModel& tool,
                      const ToolShape& shape, Add&& add) noexcept;
  static Vec3d middle(const Models&, const States& states, size_t i) noexcept { return states[i].x; }
  static Vec3d point(const Models& models, const States& states, const MaterialPoint& at) noexcept;
  static double thickness(const Models& models, const MaterialPoint& at) noexcept {
    return 2 * models.list[at.body.index()].radius;
  }
  static void pull(const Models& models, const States& states, const MaterialPoint& at, Vec3d target, HoldLaw law,
                   Tag tag, Work& work) noexcept;
  /// @param cavity  nothing leaves it
  static tissue::StepReport advance(const Models& models, Vec3d gravity, double tick, const tissue::Box& cavity,
                                    States& states, Work& work) noexcept;
  static bool overloaded(const Work& work) noexcept { return work.overflowed; }
  /// What they did to instruments: account(tag, force on the body).
  template <class Account>
  static void account(const Work& work, double tick, Account&& account) noexcept;

  /// Is it in the way of a sight? Objects are small, and nothing is looked for behind them.
  static bool hides(const Models&, const States&, Vec3d, Vec3d) noexcept { return false; }

  /// What a keyframe holds of them.
  template <class States_, class F>
  static void serialize_display(const Models&, States_& states, F&& f) {
    f(states.data(), states.size());
  }
  static bool is_valid(const States& states) noexcept;
  /// From a to b.
  static void blend(const States& a, const States& b, double f, States& out) noexcept;
};

template <class Add>
void Rigid::between(const Models& models, const States& states, size_t i, const ToolModel& tool, const ToolShape& shape,
                    Add&& add) noexcept {
  constexpr double kBeside = 0.0015, kBeyond = 0.0005;  // [m] as folds are held
  const RigidModel& m = models.list[i];
  const double far = m.reach + tool.jaw_length;
  const Vec3d off = states[i].x - shape.pivot;
  if (dot(off, off) > far * far) return;
  for (size_t g = 0; g < m.grips.size(); ++g) {
    const Vec3d local = to_jaw(shape, place_of(states[i], m.grips[g]));
    if (std::fabs(local.y) > 0.5 * tool.jaw_width + kBeside) continue;
    if (local.z < 0 || local.z > tool.jaw_length + kBeyond) continue;
    if (std::fabs(local.x) > shape.half_opening(local.z) + kBeyond) continue;
    add(std::int32_t(g), local);
  }
}

template <class Account>
void Rigid::account(const Work& work, double tick, Account&& account) noexcept {
  for (const RigidHold& h : work.holds) account(h.tag, h.force);
  for (const RigidContact& c : work.contacts)
    if (c.tag.owner != Owner::body)
      account(c.tag,
              (c.impulse.x / tick) * c.normal + (c.impulse.y / tick) * c.along + (c.impulse.z / tick) * c.across);
}

}  // namespace trocar::interactions
