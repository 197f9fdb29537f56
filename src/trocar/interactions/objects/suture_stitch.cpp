#include <algorithm>
#include <cmath>
#include <span>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/objects/suture_on_tissue.hpp>
#include <trocar/interactions/objects/suture_sling_step.hpp>
#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::interactions {
namespace {

constexpr double kTrackApart = 0.001;  // [m] of holes along a path
constexpr double kCutsWith = 0.3;      // of the puncture force: what the tip meets inside.            Our estimate
constexpr double kComesOutWith = 0.6;  // of the puncture force: skin that is stretched over a tip.     Our estimate
constexpr double kTipRubs = 1.5;       // friction of a point on skin, which catches. Our estimate
constexpr double kLeastSlip = 0.0002;  // [m] that a tip slips until it presses on another point
constexpr double kDrawnBack = 0.0004;  // [m] that a tip is drawn out of its entry until it is out
constexpr double kOffPath = 0.0015;    // [m] beside its old path the tip makes a new one
constexpr double kFirm = 0.004;        // [m] of thread that is through a hole when it is as stiff as holes are
constexpr double kThreadDrag = 0.01;   // [N] of a hole on the thread in it.                           Our estimate
constexpr double kKept = 0.003;        // [m] of a bite's way the thread's holes are apart
constexpr double kCutsThrough = 3;     // times the force that harms
constexpr double kSkinNear = 0.010;    // [m] from a hole, skin is looked for
constexpr double kOffEdge = 0.0003;    // [m] beside a fold it is out of it
constexpr double kNeedleTorque =
    0.003;                         // [N m] that fully pinched jaws bear of a needle's turning between their faces. [d]
constexpr double kFullPinch = 25;  // [N] of a needle holder
constexpr int kPartsAfter = 20;    // ticks beyond what a thread bears until it parts.            Our estimate
constexpr double kCrushes = 2;     // breaking forces on an element: its own pull presses it less on steel. Our estimate
constexpr int kCrushedAfter = 3;   // ticks of that until it parts.                               Our estimate
constexpr double kBendsWith = 0.05;   // [N] of a thread that leaves its swage aslant
constexpr int kAtSwage = 4;           // elements
constexpr double kTightens = 0.1;     // [N] a tick: a thread that is drawn at 50 mm/s tightens by a third of that
constexpr double kTautAbove = 0.002;  // [N]
constexpr double kTailWay = 1e-4, kMostTail = 2000;  // [m], [N/m] secant of the thread's pull at the swage

Vec3d across_of(Vec3d v, Vec3d n) noexcept { return v - dot(v, n) * n; }

bool is_outside_as_drawn(const tissue::Skin& skin, Vec3d p) noexcept {
  double least = 1e30;
  bool outside = true;
  for (const auto& t : skin.triangles) {
    const auto x = [&](size_t k) { return vec_cast<double>(skin.rest[size_t(t[k])]); };
    const auto at = geometry::closest_on_triangle(p, x(0), x(1), x(2));
    if (!(at.distance2 < least)) continue;
    least = at.distance2;
    outside = dot(p - at.point, cross(x(1) - x(0), x(2) - x(0))) > 0;
  }
  return outside;
}

class Sewing {
 public:
  Sewing(const SutureModels& models, size_t index, const Bodies& bodies, Vec3d gravity, double dt,
         const tissue::Box& cavity, SutureState& s, SutureWorks& all, SewnReport& report) noexcept
      : m_models(models),
        m_model(models.list[index]),
        m_index(std::int32_t(index)),
        m_bodies(bodies),
        m_gravity(gravity),
        m_dt(dt),
        m_cavity(cavity),
        m_state(s),
        m_all(all),
        m_work(all.list[index]),
        m_report(report) {}

  void move_needle() noexcept {
    if (!m_model.has_needle()) return;
    pin();
    meet_tip();
    m_work.needle.tail = {m_state.tail_force, std::min(kMostTail, length(m_state.tail_force) / kTailWay)};
    if (length(m_state.tail_force) < kTautAbove) m_work.needle.tail.stiffness = 0;
    const bool fine = suture::advance(m_model.needle, m_gravity, m_dt, m_state.needle, m_work.needle);
    if (!fine && !m_report.bad.exists()) m_report.bad = id();
    keep_in_cavity();
    take_forces();
    if (m_state.touch.kind != SutureTouch::none) press_tip();
    if (m_state.inside.exists()) follow_path();
    hand_over();
  }

  void move_thread() noexcept {
    if (!m_model.has_thread()) return;
    drive_holds();
    if (m_model.sling.there() && !lead_sling(m_model, m_dt, m_state, m_work)) return;
    drive_passages();
    const suture::ThreadReport r = suture::advance(
        m_model.thread, {m_work.holds, m_work.obstacles, m_work.skins, m_work.passages},
        {m_work.hold_reactions, m_work.obstacle_reactions, m_work.skin_reactions, m_work.passage_reactions},
        m_state.thread, m_work.thread);
    m_work.thread_report = r;
    m_state.strain = r.tension;
    if (r.flags & suture::ThreadReport::kNonFinite && !m_report.bad.exists()) m_report.bad = id();
    part_thread(r);
    take_reactions();
    if (m_model.sling.there()) settle_sling(m_model, m_dt, m_state, m_work);
  }

 private:
  BodyId id() const noexcept { return BodyId(BodyKind::suture, size_t(m_index)); }

  /// Where it is pulled apart, or crushed between steel and steel. A jerk that the solver shows for a tick or two parts
  /// nothing. A loop at the end of a tube has its knot always, which the thread runs through without touching itself.
  void part_thread(const suture::ThreadReport& r) noexcept {
    const double bears = m_model.thread.stuff.break_force;
    const auto touches = std::span(m_state.thread.touch).first(size_t(m_state.thread.touch_count));
    const auto hardest = std::max_element(touches.begin(), touches.end(),
                                          [](const auto& a, const auto& b) { return a.press < b.press; });
    const bool looped = m_model.sling.there();
    const bool overloaded = (r.flags & suture::ThreadReport::kOverloaded) != 0 ||
                            (looped && r.tension > m_model.thread.stuff.knotted_break_force);
    m_state.strained = overloaded ? m_state.strained + 1 : 0;
    m_state.crushed = hardest != touches.end() && hardest->press > kCrushes * bears ? m_state.crushed + 1 : 0;
    const bool crushed = m_state.crushed >= kCrushedAfter;
    if (!crushed && m_state.strained < kPartsAfter) return;
    const double pulled_apart = looped ? m_state.sling.knot : r.weakest;
    suture::cut(m_model.thread, m_state.thread, crushed ? (hardest->a + 0.5) * m_model.thread.spacing : pulled_apart);
    m_state.broken = 1;
    m_report.add(BrokenThread{id(), crushed ? hand_of_obstacle(hardest->b) : -1});
    m_state.strained = m_state.crushed = 0;
  }

  /// Whose instrument that is; -1: the needle.
  std::int32_t hand_of_obstacle(std::int32_t slot) const noexcept {
    const std::int32_t hand = slot / kRodSlots;
    return size_t(hand) < m_all.pinches.size() ? hand : -1;
  }

  double drag(const SutureHole& h) const noexcept { return m_models.of(h.at.body).drag * kTrackApart; }
  double puncture(BodyId body) const noexcept { return m_models.of(body).puncture; }
  Vec3d tip() const noexcept { return suture::needle_point(m_model.needle, m_state.needle, 0); }
  Vec3d drives() const noexcept { return suture::needle_direction(m_model.needle, m_state.needle, 0); }
  double arc_of(const SutureHole& h) const noexcept {
    return m_model.needle.nearest(suture::own_of(m_state.needle, place_of(m_bodies, h.at)));
  }
  SutureHole* newest() noexcept {
    for (int i = m_state.hole_count; i-- > 0;)
      if (m_state.holes[size_t(i)].slot < 0) return &m_state.holes[size_t(i)];
    return nullptr;
  }

  /// Holes that the wire is in, as the needle's pins.
  void pin() noexcept {
    for (int i = 0; i < m_state.hole_count; ++i) {
      SutureHole& h = m_state.holes[size_t(i)];
      if (h.slot >= 0) continue;
      h.force = {};
      h.arc = float(arc_of(h));
      if (h.arc < 0 || double(h.arc) > m_model.needle.length) continue;
      suture::NeedlePin p;
      p.point = place_of(m_bodies, h.at);
      p.velocity = {};  // where it is when the tick ends is known
      p.across = kAcrossWire;
      p.drag = drag(h);
      p.stuck = double(h.stuck);
      p.owner = i;
      suture::add(m_work.needle.pins, p, m_work.needle);
    }
  }

  void meet_tip() noexcept {
    const SutureTouch& t = m_state.touch;
    if (t.kind != SutureTouch::none) {
      suture::NeedleTip& meets = m_work.needle.tip;
      meets.there = true;
      meets.dir = t.kind == SutureTouch::outside ? vector_of(t.normal) : -vector_of(t.normal);
      const Vec3d off = tip() - place_of(m_bodies, t.at);
      meets.gap = -dot(off, meets.dir);
      meets.stiffness = kTipStiffness;
      meets.friction = kTipRubs;
      meets.slid = -across_of(off, meets.dir);  // tissue goes with the tip: not by what the needle has moved
    }
    const SutureHole* front = newest();
    if (!m_state.inside.exists() || !front || front->arc < 0) {
      m_state.cut = 0;
      return;
    }
    suture::NeedleTip& cuts = m_work.needle.cuts;
    cuts.there = true;
    cuts.dir = -drives();
    cuts.gap = m_state.cut;
    cuts.stiffness = kTipStiffness;
    cuts.most = kCutsWith * puncture(m_state.inside);
  }

  void keep_in_cavity() noexcept {
    suture::NeedleState& s = m_state.needle;
    for (int k = 0; k < 3; ++k) {
      const double low = double(m_cavity.low[k]), high = double(m_cavity.high[k]);
      if (s.x[k] < low) s.x[k] = low, s.v[k] = std::max(s.v[k], 0.0);
      if (s.x[k] > high) s.x[k] = high, s.v[k] = std::min(s.v[k], 0.0);
    }
  }

  void take_forces() noexcept {
    for (const suture::NeedlePin& p : m_work.needle.pins) {
      SutureHole& h = m_state.holes[size_t(p.owner)];
      h.force = array_of(-p.force);
      h.stuck = float(p.stuck);
      note_peak(length(p.force));
    }
    SutureTouch& t = m_state.touch;
    if (t.kind != SutureTouch::none) {
      t.force = array_of(m_work.needle.tip.force);
      t.slid = array_of(m_work.needle.tip.slid);
      note_peak(length(m_work.needle.tip.force));
    }
    if (m_work.needle.cuts.there) {
      m_state.cut = std::max(0.0, m_work.needle.cuts.gap);
      if (SutureHole* front = newest()) front->force = array_of(vector_of(front->force) - m_work.needle.cuts.force);
    }
  }
  void note_peak(double force) noexcept { m_state.peak = std::max(m_state.peak, force); }

  /// Does the skin under the tip give way?
  void press_tip() noexcept {
    SutureTouch& t = m_state.touch;
    const Vec3d normal = vector_of(t.normal), p = tip();
    const double along = -dot(vector_of(t.force), drives());
    const double square = std::fabs(dot(drives(), normal));
    const double bears = (t.kind == SutureTouch::inside ? kComesOutWith : 1) * puncture(t.at.body);
    if (along >= bears && square > kPricks) {
      pierce();
      return;
    }
    // what friction does not hold of its way
    const Vec3d at = place_of(m_bodies, t.at), slipped = across_of(p - at, normal) + vector_of(t.slid);
    if (length(slipped) < kLeastSlip) return;
    const NearSkin on = nearest_skin(m_bodies, t.at.body, at + slipped, kSkinNear);
    if (on.there()) t.at = attach(m_bodies, t.at.body, on.point);
  }

  bool add_hole(SutureHole::Kind kind, const MaterialPoint& at) noexcept {
    if (m_state.hole_count == kMostHoles) {
      m_report.records_full = true;
      return false;
    }
    SutureHole& h = m_state.holes[size_t(m_state.hole_count++)];
    h = {};
    h.at = at;
    h.kind = kind;
    h.bite = m_state.bite_count - 1;
    return true;
  }

  void pierce() noexcept {
    SutureTouch& t = m_state.touch;
    if (t.kind == SutureTouch::outside) {
      if (m_state.bite_count == kMostBites || m_state.hole_count == kMostHoles) {
        m_report.records_full = true;
        return;
      }
      SutureBite& bite = m_state.bites[size_t(m_state.bite_count++)];
      bite = {};
      bite.body = t.at.body;
      bite.entry = t.at;
      add_hole(SutureHole::entry, t.at);
      m_state.inside = t.at.body;
      m_state.cut = 0;
      if (t.at.body.is(BodyKind::membrane)) come_out(t.at);  // a fold has no inside
    } else if (add_hole(SutureHole::exit, t.at)) {
      come_out(t.at);
    }
    t = {};
  }
  void come_out(const MaterialPoint& at) noexcept {
    SutureBite& bite = m_state.bites[size_t(m_state.bite_count - 1)];
    bite.stage = SutureBite::through;
    bite.exit = at;
    m_state.inside = {};
    m_state.cut = 0;
  }

  /// The tip is in tissue: it continues, or back.
  void follow_path() noexcept {
    SutureHole* front = newest();
    if (!front) {
      m_state.inside = {};
      return;
    }
    const double arc = arc_of(*front);
    const double off =
        length(suture::needle_point(m_model.needle, m_state.needle, arc) - place_of(m_bodies, front->at));
    if (front->kind == SutureHole::entry && arc < -kDrawnBack) {
      drop_newest();
      m_state.inside = {};
      m_state.touch = {};
      SutureBite& bite = m_state.bites[size_t(m_state.bite_count - 1)];
      bite.stage = SutureBite::gone;
    } else if (front->kind == SutureHole::track && arc < 0) {
      const Vec3d way = place_of(m_bodies, front->at) - tip();
      if (arc < -kOffPath || off > kOffPath || length(way) > 2 * kOffPath) drop_newest();
    } else if (arc >= kTrackApart && m_state.hole_count < kMostHoles) {
      add_hole(SutureHole::track, attach(m_bodies, m_state.inside, tip()));
    }
  }
  void drop_newest() noexcept {
    SutureHole* front = newest();
    if (front) drop(int(front - m_state.holes.data()));
  }
  void drop(int i) noexcept {
    SutureHole& h = m_state.holes[size_t(i)];
    if (h.slot >= 0) suture::close_passage(m_state.thread, h.slot);
    std::copy(m_state.holes.begin() + i + 1, m_state.holes.begin() + m_state.hole_count, m_state.holes.begin() + i);
    --m_state.hole_count;
  }

  /// Holes that the swage has passed are the thread's.
  void hand_over() noexcept {
    for (int i = 0; i < m_state.hole_count; ++i) {
      SutureHole& h = m_state.holes[size_t(i)];
      if (h.slot >= 0) continue;
      const double arc = arc_of(h), behind = arc - m_model.needle.length;
      if (behind <= 0) continue;
      const int slot = m_model.has_thread() && !is_spare(i) ? free_slot() : -1;
      if (slot < 0) {
        drop(i--);
        continue;
      }
      suture::open_passage(m_model.thread, m_state.thread, slot, std::max(behind, 0.5 * m_model.thread.spacing));
      h.slot = slot;
      h.stuck = 0;
      h.force = {};
    }
  }
  /// A hole on the way, near one that the thread has already.
  bool is_spare(int i) const noexcept {
    const SutureHole& h = m_state.holes[size_t(i)];
    if (h.kind != SutureHole::track) return false;
    for (int k = 0; k < m_state.hole_count; ++k) {
      const SutureHole& other = m_state.holes[size_t(k)];
      if (k == i || other.bite != h.bite) continue;
      if (other.slot < 0 && other.kind != SutureHole::exit) continue;
      if (length(place_of(m_bodies, other.at) - place_of(m_bodies, h.at)) < kKept) return true;
    }
    return false;
  }
  int free_slot() const noexcept {
    for (size_t k = 0; k < m_state.thread.passages.size(); ++k)
      if (!m_state.thread.passages[k].active) return int(k);
    return -1;
  }

  void drive_holds() noexcept {
    for (suture::Hold& hold : m_work.holds) hold = {};
    if (m_model.has_needle()) {
      suture::Hold& swage = m_work.holds[kSwageSlot];
      const double end = m_model.needle.length;
      swage.x = suture::needle_point(m_model.needle, m_state.needle, end);
      swage.direction = -suture::needle_direction(m_model.needle, m_state.needle, end);
      swage.side = rotate(m_state.needle.q, Vec3d{0, 0, 1});
    }
    for (size_t hand = 0; hand < m_all.pinches.size(); ++hand) {
      const SuturePinch& p = m_all.pinches[hand];
      const int slot = kFirstHandSlot + int(hand);
      if (slot >= int(m_state.thread.holds.size())) continue;
      const bool held = p.count > 0 && p.suture == m_index, active = m_state.thread.holds[size_t(slot)].active != 0;
      if (active && !held) suture::release_hold(m_state.thread, slot);
      if (!held) continue;
      if (!active) suture::take_hold(m_model.thread, m_state.thread, slot, p.s / p.count);
      suture::Hold& hold = m_work.holds[size_t(slot)];
      hold.x = p.target / double(p.count);
      if (p.highest > p.lowest) hold.direction = normalised(p.last - p.first, {0, 0, 0});
      hold.friction_limit = std::max(0.001, 0.95 * p.bears);
    }
  }

  void drive_passages() noexcept {
    for (suture::Passage& p : m_work.passages) p = {};
    for (int i = 0; i < m_state.hole_count; ++i) {
      const SutureHole& h = m_state.holes[size_t(i)];
      if (h.slot < 0) continue;
      suture::Passage& p = m_work.passages[size_t(h.slot)];
      p.x = place_of(m_bodies, h.at);
      // as soft as about the wire at first: else the force would leap when the swage has passed
      p.stiffness = kAcrossWire + (kThreadHole - kAcrossWire) * std::min(1.0, double(h.arc) / kFirm);
      p.drag = kThreadDrag;
    }
  }

  /// Of the thread on the swage. Where a solve was not taken in full, the spring that ties it there is strained by what
  /// is left of its way: no more than the thread bears beside it pulls. The mean of two ticks, as both step in turn.
  Vec3d tail_pull(Vec3d force) const noexcept {
    double bears = kBendsWith;
    for (int e = 0; e < kAtSwage && e + 1 < m_model.thread.nodes; ++e)
      bears = std::max(bears, kBendsWith + suture::tension(m_model.thread, m_state.thread, e));
    bears = std::min(bears, m_model.thread.stuff.break_force);
    const double size = length(force);
    if (size > bears) force *= bears / size;
    force = 0.5 * (m_state.tail_force + force);
    const double most = length(m_state.tail_force) + kTightens, pulls = length(force);
    return pulls > most ? (most / pulls) * force : force;
  }

  void take_reactions() noexcept {
    m_state.tail_force = m_model.has_needle() ? tail_pull(m_work.hold_reactions[kSwageSlot].force) : Vec3d{};
    for (size_t hand = 0; hand < m_all.pinches.size(); ++hand) {
      SuturePinch& p = m_all.pinches[hand];
      const size_t slot = size_t(kFirstHandSlot) + hand;
      if (p.count > 0 && p.suture == m_index && slot < m_work.hold_reactions.size())
        p.force = -m_work.hold_reactions[slot].force;
    }
    for (int i = 0; i < m_state.hole_count; ++i) {
      SutureHole& h = m_state.holes[size_t(i)];
      if (h.slot < 0) continue;
      const suture::PassageState& passage = m_state.thread.passages[size_t(h.slot)];
      const Vec3d force = m_work.passage_reactions[size_t(h.slot)].force;
      const bool at_swage =
          !passage.active && m_model.has_needle() && double(h.arc) < kAtSwage * m_model.thread.spacing;
      h.arc = float(passage.s);
      h.force = array_of(force);
      if (at_swage) {  // it has slid back to the needle, whose it is again
        h.slot = -1;
        h.force = {};
        h.arc = float(m_model.needle.length);
        continue;
      }
      if (!passage.active || passage.s >= m_model.thread.length - m_model.thread.spacing) {
        drop(i--);
        continue;
      }
      pull_at(i, force);
    }
    end_bites();
  }

  /// What a thread does to tissue that it pulls at: harm, and beyond three times that it cuts its way.
  void pull_at(int i, Vec3d force) noexcept {
    SutureHole& h = m_state.holes[size_t(i)];
    SutureBite& bite = m_state.bites[size_t(h.bite)];
    const double pulled = length(force), harms = m_models.of(h.at.body).damage;
    note_peak(pulled);
    bite.peak = std::max(bite.peak, float(pulled));
    if (pulled > harms) bite.harmed = 1;
    const double most = kCutsThrough * harms;
    if (pulled > most && bite.stage != SutureBite::torn) cut_on(h, (1 / pulled) * force, (pulled - most) / kThreadHole);
  }
  /// The thread cuts its way on, in a fold along it, until it is out.
  void cut_on(SutureHole& h, Vec3d towards, double way) noexcept {
    const Vec3d at = place_of(m_bodies, h.at);
    const bool in_fold = h.at.body.is(BodyKind::membrane);
    if (in_fold) towards = across_of(towards, nearest_skin(m_bodies, h.at.body, at, kSkinNear).normal);
    const Vec3d to = at + way * towards;
    const NearSkin skin = nearest_skin(m_bodies, h.at.body, to, kSkinNear);
    h.at = attach(m_bodies, h.at.body, in_fold && skin.there() ? skin.point : to);
    h.way += float(way);
    if (in_fold ? !skin.there() || skin.distance > kOffEdge : is_out(h)) tear_out(h);
  }
  /// Of a body: by a place on the bite's way in it. Between entry and exit, where it is too short to have one. An organ
  /// is looked at as it was drawn: drawn out to a tent, it would leave the straight line between both.
  bool is_out(const SutureHole& h) const noexcept {
    const bool organ = h.at.body.is(BodyKind::organ);
    const auto place = [&](const SutureHole& of) {
      return organ ? drawn_place(m_bodies, of.at) : place_of(m_bodies, of.at);
    };
    Vec3d way = place(h);
    if (h.kind != SutureHole::track) {
      Vec3d middle;
      int ends = 0;
      for (int i = 0; i < m_state.hole_count; ++i) {
        const SutureHole& other = m_state.holes[size_t(i)];
        if (other.bite != h.bite) continue;
        if (other.kind == SutureHole::track) return false;
        middle += place(other), ++ends;
      }
      if (ends < 2) return false;
      way = (1.0 / ends) * middle;
    }
    if (organ) return is_outside_as_drawn(skin_of(m_bodies, h.at.body.index()), way);
    const NearSkin skin = nearest_skin(m_bodies, h.at.body, way, kSkinNear);
    return !skin.there() || skin.distance > 0;
  }
  void tear_out(const SutureHole& h) noexcept {
    SutureBite& bite = m_state.bites[size_t(h.bite)];
    bite.stage = SutureBite::torn;
    m_report.add(TornStitch{bite.body, id(), place_of(m_bodies, h.at), length(vector_of(h.force))});
    ++m_state.torn;
  }
  void end_bites() noexcept {
    for (int b = 0; b < m_state.bite_count; ++b) {
      SutureBite& bite = m_state.bites[size_t(b)];
      bool any = false;
      for (int i = m_state.hole_count; i-- > 0;) {
        if (m_state.holes[size_t(i)].bite != b) continue;
        if (bite.stage == SutureBite::torn)
          drop(i);
        else
          any = true;
      }
      if (!any && bite.stage == SutureBite::through) bite.stage = SutureBite::gone;
    }
  }

  const SutureModels& m_models;
  const SutureModel& m_model;
  std::int32_t m_index;
  const Bodies& m_bodies;
  Vec3d m_gravity;
  double m_dt;
  const tissue::Box& m_cavity;
  SutureState& m_state;
  SutureWorks& m_all;
  SutureWork& m_work;
  SewnReport& m_report;
};

/// Of all places that a hand holds of a needle, about their middle, in the jaws' frame.
struct Twist {
  Vec3d middle, torque;
  Mat3d stiffness;
};

Twist twist_of(const SutureWork& w, int hand, const ToolShape& shape, const ToolState& tool) noexcept {
  Twist t;
  const double share = 1.0 / tool.holds;
  const auto local = [&](int i) {
    const float* l = tool.hold[i].local;
    return Vec3d{double(l[0]), double(l[1]), double(l[2])};
  };
  for (int i = 0; i < tool.holds; ++i) t.middle += share * local(i);
  const Vec3d origin = from_jaw(shape, {0, 0, 0});
  for (size_t k = 0; k < w.needle.holds.size(); ++k) {
    const Tag& tag = w.hold_tags[k];
    if (tag.index != hand || tag.sub >= tool.holds) continue;
    const Vec3d arm = local(tag.sub) - t.middle, f = to_jaw(shape, origin + w.needle.holds[k].force);
    const double r2 = dot(arm, arm), stiff = w.needle.holds[k].stiffness;
    t.torque += cross(arm, f);
    t.stiffness = t.stiffness + stiff * (Mat3d{{{r2, 0, 0}, {0, r2, 0}, {0, 0, r2}}} - outer(arm, arm));
  }
  return t;
}

/// Flat jaws bear a twist about the way they open, and about the wire itself, by friction; about their own axis, in
/// which the wire would have to spread them, by their pinch over half their width.
Vec3d beyond_of(Vec3d torque, double pinch, double width) noexcept {
  const double rubs = kNeedleTorque * std::min(1.0, pinch / kFullPinch), spreads = 0.5 * width * pinch;
  const double in_plane = std::sqrt(torque.x * torque.x + torque.y * torque.y);
  const double f = in_plane > rubs ? 1 - rubs / in_plane : 0.0;
  const double g = std::fabs(torque.z) > spreads ? 1 - spreads / std::fabs(torque.z) : 0.0;
  return {f * torque.x, f * torque.y, g * torque.z};
}

/// The jaws' places go back by what the needle has turned against them beyond what they bear.
void turn_in_jaws(const SutureWork& w, int hand, const ToolModel& model, const ToolShape& shape,
                  ToolState& tool) noexcept {
  constexpr double kMostTurn = 0.02;  // [rad] a tick
  const Twist t = twist_of(w, hand, shape, tool);
  const Vec3d beyond = beyond_of(t.torque, tool.pinch, model.jaw_width);
  if (beyond == Vec3d{}) return;
  Mat3d k = t.stiffness;
  const double ridge = 1e-3 * trace(k) + 1e-9;
  for (int i = 0; i < 3; ++i) k.m[i][i] += ridge;
  const double det = determinant(k);
  const Vec3d a = k.column(0), b = k.column(1), c = k.column(2);
  const Vec3d by = -(1.0 / det) * Vec3d{dot(beyond, cross(b, c)), dot(a, cross(beyond, c)), dot(a, cross(b, beyond))};
  const double size = length(by);
  const Quatd turn = quat_from_rotation_vector(size > kMostTurn ? (kMostTurn / size) * by : by);
  for (int i = 0; i < tool.holds; ++i) {
    float* l = tool.hold[i].local;
    const Vec3d to = t.middle + rotate(turn, Vec3d{double(l[0]), double(l[1]), double(l[2])} - t.middle);
    for (int n = 0; n < 3; ++n) l[n] = float(to[n]);
  }
}

/// Where the grip bears no more the needle slides: the jaws have it where it is now, strained by what they bear. One
/// that is pushed against a jaw with more than the jaws' grip spreads them and comes out. [needle in jaws]
void slide_in_jaws(const SutureModel& m, const SutureState& s, const SutureWork& w, int hand, const ToolShape& shape,
                   ToolState& tool) noexcept {
  constexpr double kSpread = 0.0015;  // [m] of the needle beside the jaws' mid-plane
  double beside = 0;
  bool slides = false;
  for (size_t k = 0; k < w.needle.holds.size(); ++k) {
    const suture::NeedleHold& held = w.needle.holds[k];
    const Tag& tag = w.hold_tags[k];
    if (tag.index != hand || tag.sub >= tool.holds) continue;
    Hold& h = tool.hold[tag.sub];
    if (held.slips) {
      const Vec3d at = to_jaw(shape, suture_place(m, s, h.at.element) + (1 / held.stiffness) * held.force);
      for (int n = 0; n < 3; ++n) h.local[n] = float(at[n]);
      slides = true;
    }
    beside += double(h.local[0]) / tool.holds;
  }
  if (!slides || std::fabs(beside) < kSpread) return;
  tool.holds = 0;
  ++tool.slipped;
  for (double& p : tool.pull) p = 0;
}

/// The thread has slipped through the jaws: other nodes are between them.
void follow_thread(const SutureModel& m, const SutureState& s, int hand, ToolState& tool) noexcept {
  const size_t slot = size_t(kFirstHandSlot + hand);
  if (slot >= s.thread.holds.size() || !s.thread.holds[slot].active) return;
  double mean = 0;
  for (int i = 0; i < tool.holds; ++i) mean += (tool.hold[i].at.element - m.grips) * m.thread.spacing / tool.holds;
  const std::int32_t shift = std::int32_t(std::floor((s.thread.holds[slot].s - mean) / m.thread.spacing + 0.5));
  if (shift == 0) return;
  int kept = 0;
  for (int i = 0; i < tool.holds; ++i) {
    Hold h = tool.hold[i];
    h.at.element += shift;
    if (h.at.element >= m.grips && h.at.element < m.grip_point_count()) tool.hold[kept++] = h;
  }
  if (kept == 0 && tool.holds > 0) ++tool.slipped;
  tool.holds = kept;
}

}  // namespace

bool goes_through(const SutureModel& m, const SutureState& s, BodyId body, double arc, bool needle) noexcept {
  constexpr double kBeside = 0.0012;  // [m] of a hole's rim
  for (int b = 0; b < s.bite_count; ++b) {
    const SutureBite& bite = s.bites[size_t(b)];
    if (bite.body != body || bite.stage == SutureBite::gone || bite.stage == SutureBite::torn) continue;
    double low = 1e9, high = -1e9;  // arc lengths from the needle's tip on, the thread's behind them
    for (int i = 0; i < s.hole_count; ++i) {
      const SutureHole& h = s.holes[size_t(i)];
      if (h.bite != b) continue;
      const double at = double(h.arc) + (h.slot >= 0 ? m.needle.length : 0);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    if (bite.stage == SutureBite::open) low = -1;
    const double at = needle ? arc : arc + m.needle.length;
    if (at > low - kBeside && at < high + kBeside) return true;
  }
  return false;
}

SewnReport sew(const SutureModels& models, const Bodies& bodies, Vec3d gravity, double dt, const tissue::Box& cavity,
               Suture::States& states, SutureWorks& work) noexcept {
  SewnReport report;
  for (size_t i = 0; i < states.size(); ++i) {
    Sewing sewing(models, i, bodies, gravity, dt, cavity, states[i], work, report);
    sewing.move_needle();
    sewing.move_thread();
  }
  return report;
}

void slip_in_jaws(const SutureModels& models, const Suture::States& states, const SutureWorks& work, int hand,
                  const ToolModel& model, const ToolShape& shape, ToolState& tool) noexcept {
  if (tool.holds == 0 || !tool.hold[0].at.body.is(BodyKind::suture)) return;
  const size_t i = tool.hold[0].at.body.index();
  if (!on_needle(models.list[i], tool.hold[0].at.element)) return follow_thread(models.list[i], states[i], hand, tool);
  slide_in_jaws(models.list[i], states[i], work.list[i], hand, shape, tool);
  if (tool.holds > 0) turn_in_jaws(work.list[i], hand, model, shape, tool);
}

}  // namespace trocar::interactions
