#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/suture.hpp>
#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/interactions/objects/suture_sling_step.hpp>

namespace trocar::interactions {
namespace {

constexpr int kAroundWire = 4;          // places of the needle's surface that jaws hold, at each
constexpr double kGripsApart = 0.0005;  // [m] along it
constexpr double kSteelInJaws = 25;     // a needle between hard jaws gives so much less than tissue does
constexpr double kJustHolds = 2;        // [N] of jaws that have closed on a needle and do not press yet. Our estimate
constexpr double kGraspedThread = 0.7;  // of its diameter, by which it keeps jaws apart
constexpr double kMostNear = 1e6;

bool finite_all(const SutureState& s) noexcept {
  const auto fine = [](Vec3d v) { return finite(v) && length(v) < kMostNear; };
  if (!fine(s.needle.x) || !fine(s.needle.v) || !fine(s.needle.w)) return false;
  if (!std::isfinite(s.needle.q.w + s.needle.q.x + s.needle.q.y + s.needle.q.z)) return false;
  for (int k = 0; k < s.thread.clip_count; ++k) {
    const suture::ThreadClip& c = s.thread.clips[size_t(k)];
    if (c.count < 1 || c.count > suture::kMostClipped || !fine(c.at) || !fine(c.axis_now) || !fine(c.open_now))
      return false;
  }
  return std::all_of(s.thread.x.begin(), s.thread.x.end(), fine);
}

/// Clips that both have are seen on their way.
void blend_clips(const suture::ThreadState& a, const suture::ThreadState& b, double f, suture::ThreadState& out) {
  for (int k = 0; k < out.clip_count; ++k) {
    suture::ThreadClip& c = out.clips[size_t(k)];
    const suture::ThreadClip *from = suture::clip_of(a, c.number), *to = suture::clip_of(b, c.number);
    if (!from || !to) continue;
    c.at = from->at + f * (to->at - from->at);
    c.axis_now = normalised(from->axis_now + f * (to->axis_now - from->axis_now), to->axis_now);
    c.open_now = normalised(from->open_now + f * (to->open_now - from->open_now), to->open_now);
  }
}

/// A place of the needle's surface that jaws hold, own frame.
Vec3d grip_of(const SutureModel& m, std::int32_t place) noexcept {
  const int rows = m.grips / kAroundWire;
  const double s = m.needle.length * (place / kAroundWire) / std::max(1, rows - 1);
  const Vec3d along = m.needle.along(s), up{0, 0, 1}, out = cross(along, up);
  const Vec3d side[kAroundWire] = {out, up, -out, -up};
  return m.needle.place(s) + 0.5 * m.needle.wire * side[place % kAroundWire];
}

}  // namespace

std::int32_t grips_of(const suture::NeedleModel& needle) {
  return needle.beads > 0 ? kAroundWire * (std::int32_t(std::ceil(needle.length / kGripsApart)) + 1) : 0;
}

Vec3d suture_place(const SutureModel& m, const SutureState& s, std::int32_t place) noexcept {
  if (on_needle(m, place)) return suture::place_of(s.needle, grip_of(m, place));
  return s.thread.x[size_t(place - m.grips)];
}

void hold_from_start(const SutureModel& m, const SutureState& s, BodyId id, const ToolModel& tool,
                     const ToolShape& shape, ToolState& state) noexcept {
  for (std::int32_t g = 0; g < m.grips && state.holds < kMaxHolds; ++g) {
    const Vec3d local = to_jaw(shape, suture_place(m, s, g));
    const bool between = std::fabs(local.y) < 0.5 * tool.jaw_width && local.z > 0 && local.z < tool.jaw_length &&
                         std::fabs(local.x) < 2 * m.needle.wire;
    if (!between) continue;
    Hold& hold = state.hold[state.holds++];
    hold.at = on_object(id, g);
    hold.local[0] = float(local.x), hold.local[1] = float(local.y), hold.local[2] = float(local.z);
  }
}

bool cut_thread(const SutureModel& m, const ToolModel& tool, const ToolShape& shape, SutureState& s) noexcept {
  constexpr double kBetween = 0.0008;                        // [m] from the middle, when they have closed
  if (m.sling.there() && !s.sling.computed()) return false;  // it is in its tube, or grows out of it
  const double near = tool.jaw_length + 0.005;
  for (std::int32_t n = 0; n + 1 < m.thread.nodes; ++n) {
    if (!s.thread.alive[size_t(n)]) continue;
    const Vec3d a = s.thread.x[size_t(n)], b = s.thread.x[size_t(n) + 1], off = a - shape.pivot;
    if (dot(off, off) > near * near) continue;
    const Vec3d at = to_jaw(shape, 0.5 * (a + b));
    if (at.z < 0 || at.z > tool.jaw_length || std::fabs(at.y) > 0.5 * tool.jaw_width) continue;
    if (std::fabs(at.x) > shape.half_opening(at.z) + kBetween) continue;
    suture::cut(m.thread, s.thread, (n + 0.5) * m.thread.spacing);
    return true;
  }
  return false;
}

Suture::States Suture::start(const Models& models) {
  States states;
  for (const SutureModel& m : models.list) {
    SutureState s;
    s.needle.x = m.place;
    s.needle.q = m.turn;
    if (m.has_thread()) {
      s.thread = suture::laid(m.thread, m.path);
      if (m.has_needle()) suture::take_hold(m.thread, s.thread, kSwageSlot, 0);
    }
    s.holes.resize(kMostHoles);
    s.bites.resize(kMostBites);
    s.near.resize(size_t(m.needle.beads + m.thread.nodes));
    if (m.sling.there()) put_down_sling(m, s);
    states.push_back(std::move(s));
  }
  return states;
}

Suture::Work Suture::make_work(const Models& models, int hands) {
  Work all;
  if (models.list.empty()) return all;
  all.rods.reserve(size_t(hands) * kMostParts);
  all.pinches.resize(size_t(hands));
  for (const SutureModel& m : models.list) {
    SutureWork w;
    w.needle = suture::make_needle_work();
    w.hold_tags.reserve(suture::kMostNeedleHolds);
    w.contact_rods.reserve(suture::kMostContacts);
    if (m.has_thread()) {
      w.thread = suture::make_work(m.thread);
      w.holds.resize(size_t(m.thread.holds));
      w.obstacles.resize(size_t(m.thread.obstacles));
      w.skins.resize(size_t(m.thread.skins));
      w.passages.resize(size_t(m.thread.passages));
      w.gathered.resize(size_t(m.thread.nodes - 1));
      w.hold_reactions.resize(w.holds.size());
      w.obstacle_reactions.resize(w.obstacles.size());
      w.skin_reactions.resize(w.skins.size());
      w.passage_reactions.resize(w.passages.size());
      if (m.sling.there()) {
        w.sling.on.resize(w.skins.size());
        w.sling.stiff.resize(w.skins.size());
        w.sling.deep.resize(w.skins.size());
      }
    }
    all.list.push_back(std::move(w));
  }
  return all;
}

void Suture::clear(Work& all) noexcept {
  all.rods.clear();
  all.overflowed = false;
  for (SuturePinch& p : all.pinches) p = {};
  for (SutureWork& w : all.list) {
    suture::clear(w.needle);
    w.hold_tags.clear();
    w.contact_rods.clear();
    std::fill(w.skins.begin(), w.skins.end(), suture::SkinContact{});
    std::fill(w.gathered.begin(), w.gathered.end(), std::uint8_t(0));
    std::fill(w.obstacles.begin(), w.obstacles.end(), suture::Obstacle{});
    std::fill(w.obstacle_reactions.begin(), w.obstacle_reactions.end(), suture::ObstacleReaction{});
    w.thread_report = {};
    w.sling.hand = {};
    w.sling.force = {};
  }
}

void Suture::touch(const Models& models, const States& states, const ObjectHand& hand, Work& all) noexcept {
  if (models.list.empty()) return;
  const ToolShape& shape = hand.touching.shape;
  const Hold* held = hand.state.holds > 0 && hand.state.hold[0].at.body.is(kKind) ? &hand.state.hold[0] : nullptr;
  const double at_clip = hand.tool.jaw_length - 0.5 * hand.tool.clip_length;
  const bool astride = hand.tool.can().set_clips && shape.half_opening(at_clip) < kClipGathers;
  for (int part = kShaft; part < end_of(shape) && all.rods.size() < all.rods.capacity(); part = next(part)) {
    SutureRod rod{hand.touching.before.rod(part), shape.rod(part), {Owner::tool_contact, hand.touching.tool, 0}};
    rod.slot = hand.touching.tool * kRodSlots + (part < kToolParts ? part : kToolParts + part - kFirstLink);
    rod.cuts = is_jaw(part) && hand.tool.can().cut;
    rod.astride = is_jaw(part) && astride;
    if (held && is_jaw(part)) {
      rod.held = std::int32_t(held->at.body.index());
      rod.holds_needle = on_needle(models.list[size_t(rod.held)], held->at.element);
    }
    all.rods.push_back(rod);
  }
  for (size_t i = 0; astride && i < states.size(); ++i)
    gather_thread(models.list[i], states[i], hand.tool, shape, all.list[i].gathered);
  if (hand.touching.tool < int(all.pinches.size()))
    all.pinches[size_t(hand.touching.tool)].bears = hand.tool.friction * hand.state.pinch;
}

Vec3d Suture::middle(const Models& models, const States& states, size_t i) noexcept {
  if (models.list[i].has_needle()) return states[i].needle.x;
  return states[i].thread.x[states[i].thread.x.size() / 2];
}

Vec3d Suture::point(const Models& models, const States& states, const MaterialPoint& at) noexcept {
  const size_t i = at.body.index();
  return suture_place(models.list[i], states[i], at.element);
}

double Suture::thickness(const Models& models, const MaterialPoint& at) noexcept {
  const SutureModel& m = models.list[at.body.index()];
  return on_needle(m, at.element) ? m.needle.wire : kGraspedThread * m.thread.stuff.diameter;
}

void Suture::pull(const Models& models, const States&, const MaterialPoint& at, Vec3d target, HoldLaw law, Tag tag,
                  Work& all) noexcept {
  const size_t i = at.body.index();
  const SutureModel& m = models.list[i];
  SutureWork& w = all.list[i];
  if (on_needle(m, at.element)) {
    if (w.needle.holds.size() == w.needle.holds.capacity()) {
      all.overflowed = true;
      return;
    }
    const bool by_hand = tag.index >= 0 && size_t(tag.index) < all.pinches.size();
    w.needle.holds.push_back({grip_of(m, at.element), target, kSteelInJaws * law.stiffness, law.damping, tag.index,
                              Vec3d{}, by_hand ? std::max(kJustHolds, all.pinches[size_t(tag.index)].bears) : -1.0});
    w.hold_tags.push_back(tag);
    return;
  }
  if (tag.index < 0 || size_t(tag.index) >= all.pinches.size()) return;
  SuturePinch& p = all.pinches[size_t(tag.index)];
  const std::int32_t node = at.element - m.grips;
  if (p.count == 0 || node < p.lowest) p.lowest = node, p.first = target;
  if (p.count == 0 || node > p.highest) p.highest = node, p.last = target;
  if (p.count == 0) p.tag = tag;
  p.suture = std::int32_t(i);
  p.s += node * m.thread.spacing;
  p.target += target;
  ++p.count;
}

bool Suture::is_valid(const States& states) noexcept { return std::all_of(states.begin(), states.end(), finite_all); }

void Suture::blend(const States& a, const States& b, double f, States& out) noexcept {
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].needle.x = a[i].needle.x + f * (b[i].needle.x - a[i].needle.x);
    out[i].needle.q = slerp(a[i].needle.q, b[i].needle.q, f);
    for (size_t n = 0; n < out[i].thread.x.size(); ++n)
      out[i].thread.x[n] = a[i].thread.x[n] + f * (b[i].thread.x[n] - a[i].thread.x[n]);
    blend_clips(a[i].thread, b[i].thread, f, out[i].thread);
  }
}

}  // namespace trocar::interactions
