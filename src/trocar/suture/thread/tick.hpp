// A tick of a thread on its way: what its parts share. Internal to the step.
#pragma once

#include <trocar/suture/thread/thread.hpp>

namespace trocar::suture {

inline constexpr double kGripStiffness = 1;   ///< of a hold, in stiffnesses of an element's stretch
inline constexpr double kTurnStiffness = 50;  ///< of a hold's direction, in stiffnesses of a node's bending

/// What a tick has been given, and how far it has come.
struct Tick {
  const ThreadModel& m;
  const ThreadDrive& drive;
  ThreadState& s;
  ThreadWork& w;
  int solves = 0;                        ///< before this one
  double left = 1;                       ///< share of the tick that is left
  double h = 0;                          ///< time of this solve [s]
  double part = 0;                       ///< share of what is left that this solve takes
  double catches_up = 0;                 ///< what an obstacle may go in this solve where the tick is too short for
                                         ///< all that moves [m]; 0: it is not
  int near = 0, self = 0, touching = 0;  ///< how many pairs are near, touch each other, touch obstacles
  double reach = 0;                      ///< that the near pairs were found with [m]
  double moved = 0;                      ///< by a node since then, at most [m]
  double taken = 1;                      ///< share of its motion that the last solve was taken with
  double closest = 1e9;                  ///< axes of elements that touched, in any solve so far [m]
  bool full = false;                     ///< more touch than are remembered

  bool given_hold(int k) const { return k < int(drive.holds.size()); }
  bool given_obstacle(int k) const { return k < int(drive.obstacles.size()); }
  bool given_passage(int k) const { return k < int(drive.passages.size()); }
  bool given_skin(int k) const {
    return k < int(drive.skins.size()) && drive.skins[k].node >= 0 && drive.skins[k].node < m.nodes;
  }
};

/// A place on the curve that three neighbouring nodes draw (a quadratic B-spline): what slides through a point goes
/// over it without feeling where elements meet.
struct SmoothPlace {
  std::int32_t nodes[3] = {0, 1, 2};
  double c[3] = {0, 0, 0};
  Vec3d of(const std::vector<Vec3d>& x) const { return c[0] * x[nodes[0]] + c[1] * x[nodes[1]] + c[2] * x[nodes[2]]; }
};
inline SmoothPlace smooth_place(const ThreadModel& m, double s) {
  const double along = s / m.spacing;
  int i = int(along + 0.5);
  i = i < 1 ? 1 : (i > m.nodes - 2 ? m.nodes - 2 : i);
  const double u = along - i;
  if (u < -0.5) return {{i - 1, i, i + 1}, {-u, 1 + u, 0}};  // at the thread's ends its elements themselves
  if (u > 0.5) return {{i - 1, i, i + 1}, {0, 1 - u, u}};
  return {{i - 1, i, i + 1}, {0.5 * (0.5 - u) * (0.5 - u), 0.75 - u * u, 0.5 * (0.5 + u) * (0.5 + u)}};
}

inline bool is_zero(Vec3d a) { return a.x == 0 && a.y == 0 && a.z == 0; }
inline double hold_stiffness(const ThreadModel& m) { return kGripStiffness * m.stuff.stretch / m.spacing; }
inline double turn_stiffness(const ThreadModel& m) {
  return kTurnStiffness * m.stuff.bend / (m.spacing * m.spacing * m.spacing);
}
/// Two nodes are bent against each other at an inner one that is not next to a cut.
inline bool bends(const ThreadState& s, int i) { return s.alive[i - 1] && s.alive[i]; }

// ---- shape.cpp: lengths, directions, bends ----------------------------------------------------------------------

/// Everything that follows from positions and directors, into the scratch.
void measure(Tick& t) noexcept;
/// Nodes go a share of the solution; directors follow without spin.
void move_nodes(Tick& t, double share) noexcept;
/// Bends beyond yield stay.
void flow(Tick& t) noexcept;

// ---- slots.cpp: what the tick is given --------------------------------------------------------------------------

bool all_finite(const ThreadDrive& drive) noexcept;
/// A slot that begins sees its holder where the thread is.
void begin_slots(Tick& t) noexcept;
/// How far what leads the thread has still to go in this tick [m].
double motion_left(const Tick& t) noexcept;
/// What obstacles move in the solve.
void set_obstacle_moves(Tick& t) noexcept;
/// Where a hold, a hold's direction, or a passage is when the solve ends.
Vec3d hold_target(const Tick& t, int k) noexcept;
Vec3d aim_target(const Tick& t, int k, double share) noexcept;
Vec3d passage_target(const Tick& t, int k) noexcept;
/// The thread's unit direction where it goes through, and how far friction there is strained at most.
Vec3d passage_direction(const Tick& t, int k) noexcept;
double passage_bound(const Tick& t, int k) noexcept;
/// How a node presses on its skin.
Touch skin_touch(const Tick& t, int k) noexcept;
/// After a solve: holders are seen further on, and thread has slipped.
void move_slots(Tick& t, double share, const ThreadReactions& out) noexcept;
/// Nothing that is given has changed since the last tick.
bool undisturbed(const Tick& t) noexcept;
void report_reactions(const Tick& t, const ThreadReactions& out) noexcept;

// ---- terms.cpp: the equations of a solve ------------------------------------------------------------------------

void couple_touching(Tick& t) noexcept;
void add_terms(Tick& t) noexcept;

// ---- clips.cpp: clips on the thread ------------------------------------------------------------------------------

/// An element that is about to be parted lets its clips stay on what is beside it.
void spare_clips(const ThreadModel& m, int element, ThreadState& state) noexcept;
void couple_clips(Tick& t) noexcept;
void add_clips(Tick& t) noexcept;
/// How much of its `way` along the thread something goes until it comes to a clip, and what the clip there bears.
/// @param half  width of both [m]
double way_to_clip(const ThreadState& s, double from, double way, double half) noexcept;
double clip_stops(const ThreadState& s, double from, double way, double half) noexcept;
/// What goes `way` takes the clips along that it comes to.
void push_clips(ThreadState& s, double from, double way, double half) noexcept;
/// After a solve: thread has slipped through clips, and some have slid off its ends.
void settle_clips(Tick& t) noexcept;
void pose_clips(const ThreadModel& m, ThreadState& s) noexcept;

// ---- rubbing.cpp: friction after a solve ------------------------------------------------------------------------

/// What the solve says of its touches; `share` of its motion was taken.
void end_touches(Tick& t, double share) noexcept;
/// What friction's strains have beyond their bounds has slipped; the State remembers the rest.
void settle_touches(Tick& t) noexcept;
void settle(Touch& touch) noexcept;

// ---- presses.cpp: what it can do to obstacles -------------------------------------------------------------------

/// The most that the thread can pull with at a place that holds it [N].
double most_pull(const Tick& t, int element) noexcept;
/// The most that the thread can press on an obstacle with, by what pulls and holds it [N].
double most_press(const Tick& t, int obstacle) noexcept;

}  // namespace trocar::suture
