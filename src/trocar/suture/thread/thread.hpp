// A surgical thread: a chain of nodes with its true stiffness in stretch, bending and twist, which touches itself, rubs
// on itself, and keeps bends that went beyond its yield. Knots in it hold by friction and yielding; nothing knows that
// they are knots. What it is, how it is solved and how far it is from the real thing: docs/science/thread.md.
//
//   ThreadModel model = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.15});
//   ThreadState state = laid(model, path);                 // along a path, from its first point
//   ThreadWork work = make_work(model);
//   take_hold(model, state, 0, 0.002);                     // slot 0 holds the thread 2 mm from its beginning
//   holds[0] = {.x = tip, .friction_limit = 6};            // where that place shall be when the tick ends
//   ThreadReport report = advance(model, {.holds = holds}, {.holds = reactions}, state, work);
//
// Places along a thread are arc lengths s at rest, from its first node [m]. What a tick does to it comes in slots whose
// number is chosen when the model is built: holds, obstacles, skin contacts, passages and ties keep what they remember
// (where the thread has slipped to, how their friction is strained) in the State under their slot's number.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/suture/thread/clips.hpp>
#include <trocar/suture/thread/rub.hpp>
#include <trocar/suture/thread/sizes.hpp>
#include <trocar/suture/thread/thread_work.hpp>

namespace trocar::suture {

struct ThreadDescription {
  ThreadStuff stuff;
  double length = 0.15;        ///< at rest [m]
  double spacing = 0;          ///< of nodes [m]; 0: twice the diameter, the most at which knots are true
  double tick = 1e-3;          ///< [s]
  Vec3d gravity{0, 0, -9.81};  ///< [m/s^2]
  double drag = 2;             ///< of the air [1/s]
  int most_solves = 6;         ///< in a tick, about 1 ms for 334 nodes; beyond it the thread lags behind what holds it
  double solve_motion = 0.08;  ///< what holds and obstacles move in one solve where thread touches thread, at most,
                               ///< as a share of the diameter
  bool shaped = false;         ///< bends that stay are set from outside, in space: spin feels no moment of them
  int holds = 4, obstacles = 12, skins = 256, passages = 8, ties = 4;  ///< slots
};

struct ThreadModel {
  int nodes = 0;       ///< n
  double spacing = 0;  ///< rest length of an element [m]
  double length = 0;   ///< (n - 1) spacing [m]
  ThreadStuff stuff;
  double tick = 0;  ///< [s]
  Vec3d gravity{0, 0, 0};
  double drag = 0;  ///< [1/s]
  int most_solves = 0;
  double solve_motion = 0;       ///< [m]
  std::int32_t shaped = 0;       ///< 1: bends that stay are set from outside, in space
  double contact_stiffness = 0;  ///< of a pair of elements pressed together [N/m]
  int apart = 2;                 ///< elements e and e + apart and later may touch
  std::int32_t holds = 0, obstacles = 0, skins = 0, passages = 0, ties = 0;  ///< slots
  std::int32_t contacts = 0;                                                 ///< most pairs that are remembered

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.nodes), v("spacing", s.spacing), v("length", s.length), v("stuff", s.stuff), v("tick", s.tick),
        v("gravity", s.gravity), v("drag", s.drag), v("most_solves", s.most_solves), v("solve_motion", s.solve_motion),
        v("shaped", s.shaped), v("contact_stiffness", s.contact_stiffness), v("apart", s.apart), v("holds", s.holds),
        v("obstacles", s.obstacles), v("skins", s.skins), v("passages", s.passages), v("ties", s.ties),
        v("contacts", s.contacts);
  }
};

/// What a slot remembers.
struct HoldState {
  std::int32_t active = 0, fresh = 0;
  double s = 0;             ///< what of the thread is held now: it may slip [m]
  Vec3d seen{0, 0, 0};      ///< where the thread takes the holder to be; lags behind if it is too fast [m]
  Vec3d aim{0, 0, 0};       ///< its direction, as seen
  Vec3d side{0, 0, 0};      ///< its side, as seen
  Vec3d material{0, 0, 0};  ///< the thread's director where it was taken, along aim, side and aim x side
  double reached = 0;       ///< as in Rub, along the thread [m]
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("active", s.active), v("fresh", s.fresh), v("s", s.s), v("seen", s.seen), v("aim", s.aim), v("side", s.side),
        v("material", s.material), v("reached", s.reached);
  }
};
struct ObstacleState {
  std::int32_t active = 0;
  Vec3d a{0, 0, 0}, b{0, 0, 0};  ///< its ends as the thread takes them to be [m]
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("active", s.active), v("a", s.a), v("b", s.b);
  }
};
struct SkinState {
  std::int32_t node = -1;  ///< -1: it did not touch
  Rub rub;
  Vec3d point{0, 0, 0};  ///< of its plane in the last tick [m]
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("rub", s.rub), v("point", s.point);
  }
};
struct PassageState {
  std::int32_t active = 0, fresh = 0;
  double s = 0;         ///< what of the thread is in the tissue's point now [m]
  Vec3d seen{0, 0, 0};  ///< where the thread takes that point to be [m]
  double reached = 0;   ///< as in Rub, along the thread [m]
  double press = 0;     ///< of the thread across itself on the tissue in the last solve [N]
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("active", s.active), v("fresh", s.fresh), v("s", s.s), v("seen", s.seen), v("reached", s.reached),
        v("press", s.press);
  }
};
/// Two places of the thread that are kept as they lie to each other, whatever pulls: of a knot that is none.
struct TieState {
  std::int32_t active = 0;
  double s = 0, t = 0;    ///< [m]
  Vec3d offset{0, 0, 0};  ///< from s to t [m]
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("active", s.active), v("s", s.s), v("t", s.t), v("offset", s.offset);
  }
};

struct ThreadState {
  std::vector<Vec3d> x, v;          ///< (n) [m], [m/s]
  std::vector<Vec3d> director;      ///< (n - 1) unit, across the element, fixed in its material
  std::vector<double> twist;        ///< (n) angle between the directors of the elements at a node [rad]; ends 0
  std::vector<Vec3d> bend;          ///< (n) rest bend: two components in the material's frame, and what the last solve
                                    ///< reached beyond [rad]
  std::vector<std::uint8_t> alive;  ///< (n - 1) 0 = parted
  std::vector<HoldState> holds;
  std::vector<ObstacleState> obstacles;
  std::vector<SkinState> skins;
  std::vector<PassageState> passages;
  std::vector<TieState> ties;
  std::vector<ThreadClip> clips;  ///< (kMostThreadClips)
  std::int32_t clip_count = 0;
  std::int32_t self_count = 0, touch_count = 0;
  std::vector<ElementRub> self;   ///< (contacts) thread on thread, ordered by (a, b)
  std::vector<ElementRub> touch;  ///< (contacts) thread on obstacles, ordered by (a, b)
  std::int32_t calm = 0;          ///< ticks in which nothing moved or changed; beyond some it sleeps

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("v", s.v), v("director", s.director), v("twist", s.twist), v("bend", s.bend), v("alive", s.alive),
        v("holds", s.holds), v("obstacles", s.obstacles), v("skins", s.skins), v("passages", s.passages),
        v("ties", s.ties), v("clip_count", s.clip_count, core::only_if(s.clip_count > 0)),
        v("clips", s.clips, core::FieldNote{.hashed = s.clip_count > 0, .first = s.clip_count}),
        v("self_count", s.self_count), v("touch_count", s.touch_count), v("self", s.self, core::first(s.self_count)),
        v("touch", s.touch, core::first(s.touch_count)), v("calm", s.calm);
  }
};

/// Where a hold shall be when the tick ends. With `friction_limit` the thread slips through it beyond that pull.
struct Hold {
  Vec3d x{0, 0, 0};           ///< [m]
  Vec3d direction{0, 0, 0};   ///< unit: of the thread there, in the sense of rising s; zero: it swivels freely
  Vec3d side{0, 0, 0};        ///< unit, across `direction`, turning with the holder: the thread's spin follows it
  double friction_limit = 0;  ///< [N]; 0: it holds whatever comes
};
/// A capsule at the end of the tick: a shaft, a jaw, a needle's piece. Its slot's number stays with the same body.
struct Obstacle {
  bool present = false;
  Vec3d a{0, 0, 0}, b{0, 0, 0};              ///< ends of its axis [m]
  double radius = 0;                         ///< [m]
  double friction = -1;                      ///< below 0: the thread's on steel
  std::int32_t spared = 0, spared_end = 0;   ///< elements that it holds itself: they go through it
  std::span<const std::uint8_t> gathered{};  ///< (n - 1) 1: spared, too; empty: none

  bool spares(int element) const noexcept {
    return (element >= spared && element < spared_end) || (!gathered.empty() && gathered[std::size_t(element)] != 0);
  }
};
/// A plane that a node lies on.
struct SkinContact {
  std::int32_t node = -1;   ///< -1: none in this slot
  Vec3d point{0, 0, 0};     ///< of the plane, when the tick ends [m]; the thread's axis stays a radius above it
  Vec3d normal{0, 0, 1};    ///< unit, outwards
  Vec3d velocity{0, 0, 0};  ///< of the skin there [m/s]
  double stiffness = 1000;  ///< of the tissue there [N/m]
  double friction = -1;     ///< below 0: the thread's on tissue
  double hardens = 0;       ///< so far below it; deeper it is no harder than there [m]; 0: all the way
};
/// A point of tissue that the thread goes through. The thread slides through it, by friction: its drag, and the
/// friction of the force that turns it there (so tensions keep to T2 <= T1 e^(mu theta) + drag).
struct Passage {
  Vec3d x{0, 0, 0};         ///< of the tissue's point, when the tick ends [m]
  double stiffness = 2000;  ///< of the tissue's point [N/m]
  double drag = 0;          ///< [N]
  double friction = -1;     ///< below 0: the thread's on tissue
};
/// All that a tick is given; the number of a slot is its place. Shorter spans leave the other slots alone: their holds
/// stay where they are, their obstacles are gone.
struct ThreadDrive {
  std::span<const Hold> holds{};
  std::span<const Obstacle> obstacles{};
  std::span<const SkinContact> skins{};
  std::span<const Passage> passages{};
};

/// Of the thread on what holds it.
struct HoldReaction {
  Vec3d force{0, 0, 0};   ///< [N]
  Vec3d moment{0, 0, 0};  ///< about the hold's point [N m]
  double slipped = 0;     ///< of thread in this tick, towards rising s positive [m]
};
struct ObstacleReaction {
  Vec3d force{0, 0, 0};   ///< [N]
  Vec3d moment{0, 0, 0};  ///< about the obstacle's end a [N m]
};
struct PassageReaction {
  Vec3d force{0, 0, 0};                    ///< of the thread on the tissue's point [N]
  double tension_in = 0, tension_out = 0;  ///< on the side of lower s, and on the other [N]
  double slipped = 0;                      ///< of thread through it, towards rising s positive [m]
};
/// All that a tick gives back; any may be empty.
struct ThreadReactions {
  std::span<HoldReaction> holds{};
  std::span<ObstacleReaction> obstacles{};
  std::span<Vec3d> skins{};  ///< force of the thread on the skin [N]
  std::span<PassageReaction> passages{};
};

struct ThreadReport {
  enum Flag : std::uint32_t {
    kLagging = 1,      ///< holds or obstacles were too fast: the thread follows them in later ticks
    kFull = 2,         ///< more pairs touch than are remembered: build with more `contacts`
    kIndefinite = 4,   ///< the system could not be solved: the tick was left out
    kNonFinite = 8,    ///< something that came in is not a number: the tick was left out
    kOverloaded = 16,  ///< pulled beyond what it bears, straight or with a knot: the caller may part it at `weakest`
  };
  std::uint32_t flags = 0;
  int solves = 0;
  int contacts = 0;    ///< of thread on thread
  int coupled = 0;     ///< nodes whose equations are solved together
  double lag = 0;      ///< how far a hold or an obstacle is ahead of what the thread takes it to be [m]
  double sunk = 0;     ///< of the deepest contact of thread on thread in any solve, as a share of the diameter
  double tension = 0;  ///< largest [N]
  double weakest = 0;  ///< where that is; of a knotted thread that is overloaded, its knot [m]
  bool asleep = false;
};

/// Throws std::invalid_argument saying what is unsound.
ThreadModel build(const ThreadDescription& description);
/// A thread laid along a path, from its first point; beyond the path's end it goes straight on. It is at rest straight:
/// laid bends are elastic, and yield where they are too sharp in the first tick.
ThreadState laid(const ThreadModel& model, std::span<const Vec3d> path);

ThreadWork make_work(const ThreadModel& model);

/// Slot `slot` holds the thread at s from the next tick on. Out of range: nothing.
void take_hold(const ThreadModel& model, ThreadState& state, int slot, double s) noexcept;
void release_hold(ThreadState& state, int slot) noexcept;
/// The thread goes through tissue at s.
void open_passage(const ThreadModel& model, ThreadState& state, int slot, double s) noexcept;
void close_passage(ThreadState& state, int slot) noexcept;
/// Pinches s and t together as they lie.
void tie(const ThreadModel& model, ThreadState& state, int slot, double s, double t) noexcept;
void untie(ThreadState& state, int slot) noexcept;
/// A clip closes on the thread at these places, in their order along its legs.
/// @param axis, open  unit: along its legs from their bend on, and the way they close, as it lies now
/// @return false where there is no thread, or no room for another clip
bool set_clip(const ThreadModel& model, ThreadState& state, std::int32_t number, std::span<const double> places,
              Vec3d axis, Vec3d open) noexcept;
/// Null: it has detached.
const ThreadClip* clip_of(const ThreadState& state, std::int32_t number) noexcept;
/// Parts the thread at s: in the middle of the element there.
void cut(const ThreadModel& model, ThreadState& state, double s) noexcept;

/// One tick.
ThreadReport advance(const ThreadModel& model, const ThreadDrive& drive, const ThreadReactions& reactions,
                     ThreadState& state, ThreadWork& work) noexcept;

/// A place on the thread: element, and its share of the way along it.
struct ThreadPlace {
  int element = 0;
  double w = 0;
};
ThreadPlace place_at(const ThreadModel& model, double s) noexcept;
Vec3d point_at(const ThreadModel& model, const ThreadState& state, double s) noexcept;
/// Tension of an element [N]; below 0 where it is pushed together.
double tension(const ThreadModel& model, const ThreadState& state, int element) noexcept;

void add_to_hash(core::Hasher& hasher, const ThreadState& state) noexcept;
void add_to_hash(core::Hasher& hasher, const ThreadModel& model) noexcept;

}  // namespace trocar::suture
