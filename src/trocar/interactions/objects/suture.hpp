// Sutures: a needle with a thread swaged on, or either alone. The needle lies, is held and pierces; tissue that it has
// gone through is known by holes, points of tissue on its path, which pass over to the thread behind it.
//
//   Suture::clear(work);                                    // each tick
//   Suture::touch(models, states, hand, work);              // for each instrument
//   Suture::pull(models, states, hold, target, law, tag, work);
//   rest_on_tissue(models, bodies, ..., states, work);      // suture_on_tissue.hpp: before bodies advance
//   sew(models, bodies, ..., states, work);                 // suture_stitch.hpp: after that
//
// Needle and tissue step one after the other: tissue bears what the needle did to it in the last tick, implicitly as a
// strand's host does, and the needle goes by where the tissue is then. So what either feels of the other is the same
// force, a tick apart.
//
// Places of a suture are numbered: those of the needle's surface that jaws hold first, then the thread's nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/interactions/objects/object_hand.hpp>
#include <trocar/interactions/objects/suture_sling.hpp>
#include <trocar/interactions/objects/wall_grid.hpp>
#include <trocar/suture/needle/needle_step.hpp>
#include <trocar/suture/thread/thread.hpp>
#include <trocar/suture/thread/thread_work.hpp>
#include <trocar/tissue/base/report.hpp>

namespace trocar::interactions {

/// What a stitch meets in a body of tissue.
struct StitchTissue {
  double puncture = 0.5;  ///< of a needle's tip [N]
  double damage = 2;      ///< of a stitch's pull, from which on it harms; three times that cuts through [N]
  double drag = 50;       ///< along the wire [N/m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("puncture", s.puncture), v("damage", s.damage), v("drag", s.drag);
  }
};

struct SutureModel {
  std::string name, look, needle_look;
  suture::NeedleModel needle;  ///< without beads: there is none
  suture::ThreadModel thread;  ///< without nodes: there is none
  Vec3d place;                 ///< of the needle's centre of mass at the start [m]
  Quatd turn;
  std::vector<Vec3d> path;  ///< of the thread at the start, from the swage on [m]
  std::int32_t hand = -1;   ///< that holds the needle at the start
  std::int32_t grips = 0;   ///< places of the needle that jaws hold
  SlingModel sling;         ///< where it is a loop at the mouth of a tube

  bool has_needle() const noexcept { return needle.beads > 0; }
  bool has_thread() const noexcept { return thread.nodes > 0; }
  int grip_point_count() const noexcept { return grips + thread.nodes; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("needle_look", s.needle_look, core::kNotHashed), v("needle", s.needle), v("thread", s.thread),
        v("place", s.place), v("turn", s.turn), v("path", s.path), v("hand", s.hand), v("grips", s.grips),
        v("sling", s.sling, core::only_if(s.sling.there()));
  }
};
struct SutureModels {
  std::vector<SutureModel> list;
  WallGrid walls;                                        ///< those of the Model once more
  std::vector<StitchTissue> organs, strands, membranes;  ///< of all bodies of the Model
  std::vector<double> strangles;  ///< (strands) tension of a loop that cuts through [N]; with slings

  const StitchTissue& of(BodyId body) const noexcept {
    return body.is(BodyKind::strand) ? strands[body.index()]
                                     : (body.is(BodyKind::organ) ? organs[body.index()] : membranes[body.index()]);
  }
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list), v("organs", s.organs), v("strands", s.strands), v("membranes", s.membranes),
        v("strangles", s.strangles, core::only_if(!s.strangles.empty())), v("walls", s.walls, core::kNotHashed);
  }
};

/// Skin that the tip presses on and has not pierced. No padding.
struct SutureTouch {
  enum Kind : std::int32_t { none, outside, inside };  ///< from which side
  MaterialPoint at;
  std::int32_t kind = none;
  std::array<float, 3> normal{}, slid{}, force{};  ///< out of the body; [m]; on the needle [N]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("kind", s.kind), v("normal", s.normal), v("slid", s.slid), v("force", s.force);
  }
};
/// A point of tissue that needle or thread goes through. No padding.
struct SutureHole {
  enum Kind : std::int32_t { entry, track, exit };
  MaterialPoint at;
  std::int32_t kind = entry;
  std::int32_t bite = 0;         ///< State::bites
  std::int32_t slot = -1;        ///< the thread's passage; -1: the needle is in it
  float arc = 0;                 ///< on the needle from the tip, or on the thread from the swage [m]
  float stuck = 0;               ///< strain of friction along the wire [m]
  float way = 0;                 ///< by which the pull has cut it on [m]
  std::array<float, 3> force{};  ///< on the tissue in the last tick [N]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("kind", s.kind), v("bite", s.bite), v("slot", s.slot), v("arc", s.arc), v("stuck", s.stuck),
        v("way", s.way), v("force", s.force);
  }
};
/// A way through a body. No padding.
struct SutureBite {
  enum Stage : std::int32_t { open, through, torn, gone };  ///< the tip is in it; it has come out; cut out; drawn out
  BodyId body;
  std::int32_t stage = open;
  std::int32_t harmed = 0;    ///< 1: pulled at with more than the tissue bears unharmed
  float peak = 0;             ///< the most that it was pulled at with [N]
  MaterialPoint entry, exit;  ///< where it went in, and came out

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("stage", s.stage), v("harmed", s.harmed), v("peak", s.peak), v("entry", s.entry),
        v("exit", s.exit);
  }
};

inline constexpr int kMostHoles = suture::kMostPins, kMostBites = 32, kMostPassages = 24;

struct SutureState {
  suture::NeedleState needle;
  suture::ThreadState thread;
  SutureTouch touch;
  BodyId inside;  ///< the body that the tip is in
  std::int32_t hole_count = 0, bite_count = 0;
  std::vector<SutureHole> holes;    ///< (kMostHoles) as they were made
  std::vector<SutureBite> bites;    ///< (kMostBites)
  std::vector<MaterialPoint> near;  ///< (beads, then nodes) of tissue, what each was nearest to last
  double cut = 0;                   ///< strain of what the tip cuts [m]
  std::array<double, 2> tail{};     ///< tension at the swage in the last tick [N], its stiffness [N/m]
  Vec3d tail_force{0, 0, 0};        ///< of the thread on the needle [N]
  double peak = 0;                  ///< the most that it did to tissue so far, at one hole or under the tip [N]
  double strain = 0;                ///< the thread's greatest tension now [N]
  std::int32_t torn = 0;            ///< bites that were torn out so far
  std::int32_t broken = 0;          ///< 1: the thread was pulled apart, or crushed between steel
  std::int32_t strained = 0;        ///< ticks in a row in which it bore more than it bears
  std::int32_t crushed = 0;         ///< ticks in a row in which steel pressed on it harder than it bears
  SlingState sling;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("needle", s.needle), v("thread", s.thread), v("touch", s.touch), v("inside", s.inside),
        v("hole_count", s.hole_count), v("bite_count", s.bite_count), v("holes", s.holes, core::first(s.hole_count)),
        v("bites", s.bites, core::first(s.bite_count)), v("near", s.near), v("cut", s.cut), v("tail", s.tail),
        v("tail_force", s.tail_force), v("peak", s.peak), v("strain", s.strain), v("torn", s.torn),
        v("broken", s.broken), v("strained", s.strained), v("crushed", s.crushed, core::only_if(s.crushed > 0)),
        v("sling", s.sling, core::only_if(s.sling.fed > 0));
  }
};

/// Part of an instrument that pushes.
struct SutureRod {
  collision::Capsule before, now;
  Tag tag;
  std::int32_t slot = 0;   ///< of a thread's obstacles
  std::int32_t held = -1;  ///< the suture that its jaws hold
  bool holds_needle = false;
  bool cuts = false;     ///< a blade, which thread lies between
  bool astride = false;  ///< a leg of an applier that has all but closed: it does not push what is between both
};
/// What a hand's jaws do to a thread: the mean of the places between them.
struct SuturePinch {
  std::int32_t count = 0, suture = -1;
  double s = 0;       ///< sum of arc lengths [m]
  Vec3d target;       ///< sum [m]
  Vec3d first, last;  ///< targets of the lowest and the highest node
  std::int32_t lowest = 0, highest = 0;
  double bears = 0;  ///< [N]
  Tag tag;
  Vec3d force;  ///< out: of the jaws on the thread [N]
};
struct SutureWork {
  suture::NeedleWork needle;
  suture::ThreadWork thread;
  std::vector<Tag> hold_tags;                        ///< (needle.holds)
  std::vector<std::int32_t> contact_rods;            ///< (needle.contacts) -1: none of an instrument
  std::vector<suture::Hold> holds;                   ///< (slots)
  std::vector<suture::Obstacle> obstacles;           ///< (slots)
  std::vector<suture::SkinContact> skins;            ///< (nodes)
  std::vector<suture::Passage> passages;             ///< (slots)
  std::vector<std::uint8_t> gathered;                ///< (elements) 1: between the legs of an applier
  std::vector<suture::HoldReaction> hold_reactions;  ///< (slots)
  std::vector<suture::ObstacleReaction> obstacle_reactions;
  std::vector<Vec3d> skin_reactions;
  std::vector<suture::PassageReaction> passage_reactions;
  suture::ThreadReport thread_report;
  SlingWork sling;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("needle", s.needle), v("thread", s.thread), v("hold_tags", s.hold_tags), v("contact_rods", s.contact_rods),
        v("holds", s.holds), v("obstacles", s.obstacles), v("skins", s.skins), v("passages", s.passages),
        v("gathered", s.gathered), v("hold_reactions", s.hold_reactions), v("obstacle_reactions", s.obstacle_reactions),
        v("skin_reactions", s.skin_reactions), v("passage_reactions", s.passage_reactions),
        v("thread_report", s.thread_report), v("sling", s.sling);
  }
};
struct SutureWorks {
  std::vector<SutureWork> list;
  std::vector<SutureRod> rods;
  std::vector<SuturePinch> pinches;  ///< (hands)
  bool overflowed = false;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list), v("rods", s.rods), v("pinches", s.pinches), v("overflowed", s.overflowed);
  }
};

/// Slots of a thread's obstacles: parts of each hand, then pieces of the needle.
inline constexpr int kNeedlePieces = 6, kRodSlots = kToolParts + kinematics::kMaxLinks;
inline constexpr int kSwageSlot = 0, kFirstHandSlot = 1;  ///< of its holds

/// How many places of a needle jaws hold.
std::int32_t grips_of(const suture::NeedleModel& needle);
/// Where a place of a suture is.
Vec3d suture_place(const SutureModel& m, const SutureState& s, std::int32_t place) noexcept;
/// Is the place one of the needle?
inline bool on_needle(const SutureModel& m, std::int32_t place) noexcept { return place < m.grips; }

/// Blades that have just closed part a thread that lies between them, once. @return did it?
bool cut_thread(const SutureModel& m, const ToolModel& tool, const ToolShape& shape, SutureState& s) noexcept;
/// Jaws that hold the needle from the start close on it in the first tick.
void hold_from_start(const SutureModel& m, const SutureState& s, BodyId id, const ToolModel& tool,
                     const ToolShape& shape, ToolState& state) noexcept;

/// The kind, as object_kinds.hpp lists it.
struct Suture {
  static constexpr BodyKind kKind = BodyKind::suture;
  static constexpr bool kIsTissue = false;
  static constexpr bool kRigidInJaws = true;
  using Models = SutureModels;
  using States = std::vector<SutureState>;
  using Work = SutureWorks;

  template <class All>
  static auto& part(All& all) noexcept {
    return all.sutures;
  }
  static int count(const Models& m) noexcept { return int(m.list.size()); }
  static const std::string& name(const Models& m, size_t i) noexcept { return m.list[i].name; }
  static const std::string& look(const Models& m, size_t i) noexcept { return m.list[i].look; }
  static int grip_point_count(const Models& m, size_t i) noexcept { return m.list[i].grip_point_count(); }

  static States start(const Models& models);
  static Work make_work(const Models& models, int hands);

  static void clear(Work& work) noexcept;
  static void touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept;
  template <class Add>
  static void between(const Models& models, const States& states, size_t i, const ToolModel& tool,
                      const ToolShape& shape, Add&& add) noexcept;
  /// Of the needle, or of the thread.
  static Vec3d middle(const Models& models, const States& states, size_t i) noexcept;
  static Vec3d point(const Models& models, const States& states, const MaterialPoint& at) noexcept;
  static double thickness(const Models& models, const MaterialPoint& at) noexcept;
  static void pull(const Models& models, const States& states, const MaterialPoint& at, Vec3d target, HoldLaw law,
                   Tag tag, Work& work) noexcept;
  /// It moves after tissue has (suture_stitch.hpp).
  static tissue::StepReport advance(const Models&, Vec3d, double, const tissue::Box&, States&, Work&) noexcept {
    return {};
  }
  static bool overloaded(const Work& work) noexcept { return work.overflowed; }
  template <class Account>
  static void account(const Work& work, double tick, Account&& account) noexcept;
  static bool hides(const Models&, const States&, Vec3d, Vec3d) noexcept { return false; }

  /// The needle's pose, the thread's nodes to 10 um beside its middle, what is whole of it, how often it was drawn in.
  template <class States_, class F>
  static void serialize_display(const Models& models, States_& states, F&& f);
  static bool is_valid(const States& states) noexcept;
  static void blend(const States& a, const States& b, double f, States& out) noexcept;
};

/// Nodes that follow each other, from the first to before the end.
struct ThreadRun {
  std::int32_t first = 0, end = 0;
};
/// Of all stretches of the thread between the jaws the one nearest to their tips: a hand holds one.
template <class Inside>
ThreadRun run_between(const SutureModel& m, const SutureState& s, const ToolModel& tool, const ToolShape& shape,
                      Inside&& inside) noexcept {
  const double near = tool.jaw_length + 0.005;
  ThreadRun best, run;
  double reached = -1, sum = 0;
  const auto end_run = [&] {
    const double mean = run.end > run.first ? sum / (run.end - run.first) : -1;
    if (run.end > run.first + 1 && mean > reached) reached = mean, best = run;
  };
  for (std::int32_t n = 0; n < m.thread.nodes; ++n) {
    if (m.sling.there() && s.sling.lies_in_tube(n * m.thread.spacing)) break;
    const Vec3d off = s.thread.x[size_t(n)] - shape.pivot;
    if (dot(off, off) >= near * near) continue;
    const Vec3d local = to_jaw(shape, s.thread.x[size_t(n)]);
    if (!inside(local)) continue;
    if (n != run.end || run.end == run.first) end_run(), run = {n, n}, sum = 0;
    run.end = n + 1;
    sum += local.z;
  }
  end_run();
  return best;
}

template <class Add>
void Suture::between(const Models& models, const States& states, size_t i, const ToolModel& tool,
                     const ToolShape& shape, Add&& add) noexcept {
  constexpr double kBeside = 0.0003, kBeyond = 0.0005;  // [m]
  const SutureModel& m = models.list[i];
  const SutureState& s = states[i];
  const auto inside = [&](Vec3d local) {
    if (std::fabs(local.y) > 0.5 * tool.jaw_width + kBeside) return false;
    if (local.z < 0 || local.z > tool.jaw_length + kBeyond) return false;
    return std::fabs(local.x) <= shape.half_opening(local.z) + kBeyond;
  };
  const auto offer = [&](std::int32_t place) {
    const Vec3d local = to_jaw(shape, suture_place(m, s, place));
    if (!inside(local)) return false;
    add(place, local);
    return true;
  };
  bool any = false;
  if (m.has_needle()) {
    const double far = m.needle.length + tool.jaw_length;
    const Vec3d off = s.needle.x - shape.pivot;
    if (dot(off, off) < far * far)
      for (std::int32_t g = 0; g < m.grips; ++g) any = offer(g) || any;
  }
  if (any) return;  // a needle in the jaws takes what there is of room
  const ThreadRun run = run_between(m, s, tool, shape, inside);
  for (std::int32_t n = run.first; n < run.end; ++n) offer(m.grips + n);
}

template <class Account>
void Suture::account(const Work& work, double, Account&& account) noexcept {
  for (const SutureWork& w : work.list) {
    for (size_t i = 0; i < w.needle.holds.size(); ++i) account(w.hold_tags[i], w.needle.holds[i].force);
    for (size_t i = 0; i < w.needle.contacts.size() && i < w.contact_rods.size(); ++i)
      if (w.contact_rods[i] >= 0) account(work.rods[size_t(w.contact_rods[i])].tag, w.needle.contacts[i].force);
    for (const SutureRod& rod : work.rods)
      if (size_t(rod.slot) < w.obstacle_reactions.size())
        account(rod.tag, -w.obstacle_reactions[size_t(rod.slot)].force);
    if (w.sling.hand.hand >= 0) account({Owner::tool_contact, w.sling.hand.hand, 0}, -w.sling.force);
  }
  for (const SuturePinch& p : work.pinches)
    if (p.count > 0) account(p.tag, p.force);
}

template <class States_, class F>
void Suture::serialize_display(const Models&, States_& states, F&& f) {
  constexpr bool kWrites = std::is_const_v<States_>;
  constexpr double kStep = 1e-5, kMost = 32000;  // [m], steps
  for (auto& s : states) {
    // one number for both: keyframes of threads without clips are what they were before there were any
    std::int32_t broken_and_clips = s.broken + 2 * s.thread.clip_count;
    f(&s.needle.x, 1), f(&s.needle.q, 1), f(&broken_and_clips, 1);
    const std::int32_t clips = std::clamp(broken_and_clips / 2, 0, std::int32_t(s.thread.clips.size()));
    if constexpr (!kWrites) s.broken = broken_and_clips & 1, s.thread.clip_count = clips;
    f(s.thread.clips.data(), std::size_t(clips));
    f(s.thread.alive.data(), s.thread.alive.size());
    if (s.sling.fed > 0) {
      f(&s.sling.stage, 1), f(&s.sling.parted, 1), f(&s.sling.fed, 1), f(&s.sling.knot, 1);
      if (s.sling.computed()) f(&s.sling.around_count, 1), f(s.sling.around.data(), s.sling.around.size());
    }
    if (s.thread.x.empty()) continue;
    Vec3d middle = s.thread.x[s.thread.x.size() / 2];
    f(&middle, 1);
    std::vector<std::int16_t> at(3 * s.thread.x.size());
    if constexpr (kWrites)
      for (size_t n = 0; n < s.thread.x.size(); ++n)
        for (int c = 0; c < 3; ++c)
          at[3 * n + size_t(c)] = std::int16_t(std::clamp((s.thread.x[n][c] - middle[c]) / kStep, -kMost, kMost));
    f(at.data(), at.size());
    if constexpr (!kWrites)
      for (size_t n = 0; n < s.thread.x.size(); ++n)
        for (int c = 0; c < 3; ++c) s.thread.x[n][c] = middle[c] + kStep * double(at[3 * n + size_t(c)]);
  }
}

}  // namespace trocar::interactions
