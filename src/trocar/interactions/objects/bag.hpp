// A retrieval bag: cloth that hangs from a hoop, which comes out of the end of its instrument's sleeve. What is put
// through the mouth stays in, the mouth is drawn shut by drawing the hoop back, and neck and contents go out by the
// port.
//
//   hoop    a ring in the plane of the sleeve's axis, tip to tip with the sleeve; as much of it is out as the hand
//           wants. It goes where the sleeve goes: a hand does not feel it
//   cloth   nodes in rows around, tied by threads that bear pull and no pressure, and by a little stiffness that keeps
//           it from falling flat. Positions are corrected until threads are no longer than they are, and what is in it
//           lies on its own side (bag_cloth.hpp)
//   inside  what has come through the mouth from above is inside until it leaves through the mouth (bag_contents.hpp)
//
// A bag that lies in its sleeve costs nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/interactions/objects/object_hand.hpp>
#include <trocar/tissue/base/report.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::interactions {

/// Two nodes that are no further apart than this; of a bend: no nearer, softly.
struct BagThread {
  std::int32_t a = 0, b = 0;
  double length = 0;  ///< [m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("a", s.a), v("b", s.b), v("length", s.length);
  }
};
/// A pouch that may be put into it: its number, and which of the bag's points are its nodes.
struct BagPouch {
  std::int32_t membrane = 0, first = 0, count = 0, reserved = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("membrane", s.membrane), v("first", s.first), v("count", s.count), v("reserved", s.reserved);
  }
};

struct BagModel {
  std::string name, look;
  double hoop = 0;                    ///< radius of the open mouth [m]
  double deep = 0;                    ///< from the mouth to the bottom [m]
  double mass = 0;                    ///< of a node [kg]
  std::int32_t around = 0, rows = 0;  ///< nodes in a row; rows, the first on the hoop; the bottom is one node more
  std::vector<Vec3d> drawn;  ///< nodes of the open bag: hoop's middle at 0, z out of the mouth, x along the axis
  std::vector<BagThread> threads, bends;
  std::vector<BagThread> reins;  ///< from the hoop to each node: no further than the cloth in between is long
  std::vector<std::array<std::int32_t, 3>> triangles;    ///< counter-clockwise seen from outside
  std::vector<std::int32_t> face_first, face;            ///< CSR: triangles at a node
  std::vector<std::int32_t> neighbour_first, neighbour;  ///< CSR: nodes that share a triangle
  std::int32_t rigids = 0;                               ///< the first points are rigid bodies' middles ...
  std::vector<BagPouch> pouches;                         ///< ... then come nodes of pouches
  std::int32_t points = 0;

  int nodes() const noexcept { return int(drawn.size()); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed), v("hoop", s.hoop), v("deep", s.deep),
        v("mass", s.mass), v("around", s.around), v("rows", s.rows), v("drawn", s.drawn), v("threads", s.threads),
        v("bends", s.bends), v("reins", s.reins), v("triangles", s.triangles), v("face_first", s.face_first),
        v("face", s.face), v("neighbour_first", s.neighbour_first), v("neighbour", s.neighbour), v("rigids", s.rigids),
        v("pouches", s.pouches), v("points", s.points);
  }
};
struct BagModels {
  std::vector<BagModel> list;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list);
  }
};

/// Where the sleeve's end is. No padding.
struct BagFrame {
  Vec3d tip;                          ///< [m]
  Vec3d axis{0, 0, -1}, up{0, 1, 0};  ///< along the sleeve; out of the mouth: unit, square

  Vec3d side() const noexcept { return cross(up, axis); }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("tip", s.tip), v("axis", s.axis), v("up", s.up);
  }
};
/// What may be in it: a rigid body's middle, or a node of a pouch.
struct BagPoint {
  enum Where : std::int16_t { elsewhere, over_mouth, inside };
  std::int16_t where = elsewhere;
  std::int16_t node = 0;  ///< of the cloth, nearest to it last

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("where", s.where), v("node", s.node);
  }
};
/// The skin that a node was nearest to last.
struct BagSkin {
  std::int32_t surface = -1, vertex = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("surface", s.surface), v("vertex", s.vertex);
  }
};

struct BagState {
  double hoop = 0;          ///< share of it that is out of the sleeve
  double unrolled = 0;      ///< the most of it so far; below 1 the cloth is laid where the hoop takes it
  BagFrame frame;           ///< where the sleeve ends, or ended when the hand put it down: it hangs on its string then
  std::int32_t hand = -1;   ///< that has it; -1: none yet
  std::int32_t out = 0;     ///< 1: its neck has been drawn into the port, shut
  std::vector<Vec3d> x, v;  ///< (nodes) [m], [m/s]
  std::vector<BagPoint> points;  ///< (points)
  std::vector<BagSkin> skins;    ///< (nodes)

  bool there() const noexcept { return hoop > 0 || unrolled > 0; }
  bool open() const noexcept { return hoop >= 0.9; }
  bool shut() const noexcept { return unrolled >= 1 && hoop <= kShut; }
  Vec3d middle(const BagModel& m) const noexcept { return frame.tip + hoop * m.hoop * frame.axis; }

  static constexpr double kShut = 0.05;  ///< share of the hoop at which nothing comes through the mouth
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("hoop", s.hoop), v("unrolled", s.unrolled), v("frame", s.frame), v("hand", s.hand), v("out", s.out), v("x", s.x),
        v("v", s.v), v("points", s.points), v("skins", s.skins);
  }
};

/// What is heavier than a node is taken to be as light as one: a few sweeps would not carry it on cloth that gives
/// nothing. So the bag sags no deeper for what is in it, and a hand would not feel that, either.
inline constexpr double kLightest = 1;

/// A point as it is in this tick: who fills in moves what has been moved.
struct BagBody {
  Vec3d x, moved{0, 0, 0};  ///< where it is; what the cloth has moved it by [m]
  Vec3d speed;              ///< [m/s]
  double radius = 0;        ///< [m]
  double light = 0;         ///< a node's mass over its own, kLightest at least; 0: nothing moves it
  bool near = false;        ///< could the bag reach it?
};
/// A node in what yields, or in what does not.
struct BagPress {
  std::int32_t node = 0;
  Vec3d at, normal;  ///< a plane that it is to stay above
  double give = 0;   ///< of what yields, a node's mass / (its stiffness tick^2)
};
/// A point at the cloth, or at the hoop (nodes below 0).
struct BagTouch {
  std::int32_t point = 0;
  std::array<std::int32_t, 3> nodes{-1, -1, -1};
  Vec3d weights, normal;  ///< of the nodes; towards the point's side
  Vec3d hoop;             ///< the place of the hoop
  double away = 0;        ///< that the point has to keep [m]
  double pressed = 0;     ///< by how much it was moved out [m]
};
struct BagRod {
  collision::Capsule now;
};
struct BagWork {
  std::vector<Vec3d> before, normal;  ///< (nodes) when the tick began; of the cloth, outwards
  std::vector<BagBody> bodies;        ///< (points)
  std::vector<BagPress> presses;
  std::vector<BagTouch> touches;
  std::vector<BagRod> rods;
  double narrowest = 0;  ///< share of the hoop that what lies in the mouth leaves
  tissue::Box bounds;    ///< of the cloth
  bool overflowed = false;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("before", s.before), v("normal", s.normal), v("bodies", s.bodies), v("presses", s.presses),
        v("touches", s.touches), v("rods", s.rods), v("narrowest", s.narrowest), v("bounds", s.bounds),
        v("overflowed", s.overflowed);
  }
};
struct BagWorks {
  std::vector<BagWork> list;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list);
  }
};

/// The kind, as object_kinds.hpp lists it. Jaws do not take hold of it. What moves it needs other bodies and is a stage
/// of its own (sim/bodies/bag.hpp).
struct Bag {
  static constexpr BodyKind kKind = BodyKind::bag;
  static constexpr bool kIsTissue = false;
  static constexpr bool kRigidInJaws = false;
  using Models = BagModels;
  using States = std::vector<BagState>;
  using Work = BagWorks;

  template <class All>
  static auto& part(All& all) noexcept {
    return all.bags;
  }
  static int count(const Models& m) noexcept { return int(m.list.size()); }
  static const std::string& name(const Models& m, size_t i) noexcept { return m.list[i].name; }
  static const std::string& look(const Models& m, size_t i) noexcept { return m.list[i].look; }
  static int grip_point_count(const Models&, size_t) noexcept { return 0; }

  static States start(const Models& models);
  static Work make_work(const Models& models, int hands);

  static void clear(Work& work) noexcept;
  /// Rods that push cloth aside.
  static void touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept;
  template <class Add>
  static void between(const Models&, const States&, size_t, const ToolModel&, const ToolShape&, Add&&) noexcept {}
  static Vec3d middle(const Models& models, const States& states, size_t i) noexcept {
    return states[i].middle(models.list[i]);
  }
  static tissue::StepReport advance(const Models&, Vec3d, double, const tissue::Box&, States&, Work&) noexcept {
    return {};
  }
  static bool overloaded(const Work& work) noexcept;
  template <class Account>
  static void account(const Work&, double, Account&&) noexcept {}
  /// One sees through it.
  static bool hides(const Models&, const States&, Vec3d, Vec3d) noexcept { return false; }

  /// Hoop and frame, what is where, and nodes to 10 um beside the hoop's middle.
  template <class States_, class F>
  static void serialize_display(const Models& models, States_& states, F&& f);
  static bool is_valid(const States& states) noexcept;
  static void blend(const States& a, const States& b, double f, States& out) noexcept;
};

template <class States_, class F>
void Bag::serialize_display(const Models& models, States_& states, F&& f) {
  constexpr bool kWrites = std::is_const_v<States_>;
  constexpr double kStep = 1e-5, kMost = 32000;  // [m], steps
  for (size_t i = 0; i < states.size(); ++i) {
    auto& s = states[i];
    f(&s.hoop, 1), f(&s.unrolled, 1), f(&s.frame, 1), f(&s.hand, 1), f(&s.out, 1);
    f(s.points.data(), s.points.size());
    const Vec3d middle = s.middle(models.list[i]);
    std::vector<std::int16_t> at(3 * s.x.size());
    if constexpr (kWrites)
      for (size_t n = 0; n < s.x.size(); ++n)
        for (int c = 0; c < 3; ++c)
          at[3 * n + size_t(c)] = std::int16_t(std::clamp((s.x[n][c] - middle[c]) / kStep, -kMost, kMost));
    f(at.data(), at.size());
    if constexpr (!kWrites)
      for (size_t n = 0; n < s.x.size(); ++n)
        for (int c = 0; c < 3; ++c) s.x[n][c] = middle[c] + kStep * double(at[3 * n + size_t(c)]);
  }
}

}  // namespace trocar::interactions
