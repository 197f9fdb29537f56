#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/fat.hpp>

namespace trocar::interactions {
namespace {

constexpr double kContact = 300;         // [N/m] a lobule at an instrument, implicit
constexpr double kContactDamped = 0.02;  // [N s/m]
constexpr double kQuickest = 0.0012;     // [m] a tick, beyond the instrument's way
constexpr double kSlips = 0.005;         // [m/s] above it friction is Coulomb's, below it viscous
constexpr double kFatCompressed = 0.6;   // thickness between jaws that just hold it, of its diameter
constexpr float kStays = 10;             // [N s/m] what is gone is nowhere: its node is kept where it was
constexpr size_t kLoadsPerLobule = 13;   // one of them of its root

/// A lobule that a part of an instrument presses on.
void push(const Capsule& rod, double way, Vec3d rod_velocity, double friction, Tag tag, int lobule, Vec3d p, Vec3d v,
          double radius, NetworkLoads& loads) noexcept {
  const Vec3d off = p - collision::nearest_on_axis(rod, p);
  const double apart = length(off), depth = rod.radius + radius - apart;
  if (depth <= 0) return;
  const Vec3d n = normalised(off, any_perpendicular(normalised(rod.b - rod.a, Vec3d{0, 0, 1})));
  const double counts = std::min(depth, kQuickest + way);
  tissue::NodeLoad load;
  load.node = lobule;
  load.k = float(kContact);
  load.d = float(kContactDamped);
  load.dir = vec_cast<float>(n);
  load.x0 = vec_cast<float>(p + counts * n);
  load.f0 = vec_cast<float>(kContactDamped * dot(rod_velocity, n) * n);
  loads.add(load, tag);
  const Vec3d slip = v - rod_velocity, across = slip - dot(slip, n) * n;
  tissue::NodeLoad rub;
  rub.node = lobule;
  rub.d = float(friction * kContact * counts / std::max(length(across), kSlips));
  rub.f0 = vec_cast<float>(double(rub.d) * rod_velocity);
  loads.add(rub, tag);
}

bool holds_lobule(const ToolState& tool, BodyId body, int lobule) noexcept {
  for (int i = 0; i < tool.holds; ++i)
    if (tool.hold[i].at.body == body && tool.hold[i].at.node[0] == lobule) return true;
  return false;
}

/// Of a part at a lobule: jaws' inner faces are toothed, and what lies between them does not slip out as they close.
double friction_at(const ObjectHand& hand, int part, Vec3d p, double radius) noexcept {
  const ToolShape& shape = hand.touching.shape;
  const bool inside = is_jaw(part) && !shape.has_foot && lies_between(hand.tool, shape, to_jaw(shape, p), radius);
  return inside ? std::max(hand.tool.friction, hand.tool.rubbing) : hand.tool.rubbing;
}

void touch_part(const tissue::FatModel& m, const tissue::FatState& s, BodyId body, const ObjectHand& hand, int part,
                NetworkLoads& loads) noexcept {
  const Capsule& rod = hand.touching.shape.rod(part);
  const Capsule& was = hand.touching.before.rod(part);
  const double reach = rod.radius + m.radius;
  const Vec3d velocity = (0.5 / core::kTick) * ((rod.a - was.a) + (rod.b - was.b));
  const Tag tag{Owner::tool_contact, hand.touching.tool, 0};
  for (int n = 0; n < m.lobules(); ++n) {
    if (s.lobules[size_t(n)].gone()) continue;
    const Vec3d p = tissue::position(m, s, n);
    const Vec3d off = p - collision::nearest_on_axis(rod, p);
    if (dot(off, off) > reach * reach || (is_jaw(part) && holds_lobule(hand.state, body, n))) continue;
    push(rod, hand.touching.way(part), velocity, friction_at(hand, part, p, m.radius), tag, n, p,
         tissue::velocity(m, s, n), m.radius, loads);
  }
}

/// Could the instrument be at any of them?
bool is_near(const tissue::FatModel& m, const tissue::FatState& s, const ToolShape& shape) noexcept {
  constexpr double kNearFat = 0.03;  // [m]
  const auto near = [](Vec3d p, Vec3d from, Vec3d to) {
    const Vec3d off = p - collision::nearest_on_axis({from, to, 0}, p);
    return dot(off, off) < kNearFat * kNearFat;
  };
  for (int n = 0; n < m.lobules(); n += 8) {  // those between them are not far
    const Vec3d p = tissue::position(m, s, n);
    if (near(p, shape.part[kShaft].a, shape.frame.tip)) return true;
    for (int i = 0; i < shape.links; ++i)
      if (near(p, shape.link[i].a, shape.link[i].b)) return true;
  }
  return false;
}

void stay(const tissue::FatState& s, NetworkLoads& loads) noexcept {
  if (s.gone == 0) return;
  for (size_t n = 0; n < s.lobules.size(); ++n) {
    if (!s.lobules[n].gone()) continue;
    tissue::NodeLoad load;
    load.node = int(n);
    load.d = kStays;
    loads.add(load, {Owner::anchor, 0, 0});
  }
}

void keep_in(const tissue::Box& cavity, const tissue::FatModel& m, tissue::FatState& s) noexcept {
  for (int n = 0; n < m.lobules(); ++n) {
    Vec3d p = tissue::position(m, s, n);
    bool outside = false;
    for (int c = 0; c < 3; ++c) {
      const double inside = std::clamp(p[c], double(cavity.low[c]), double(cavity.high[c]));
      outside = outside || inside != p[c];
      p[c] = inside;
    }
    if (!outside) continue;
    tissue::set_position(m.network, s.network, n, p);
    tissue::set_velocity(m.network, s.network, n, {});
  }
}

}  // namespace

Fat::States Fat::start(const Models& models) {
  States states;
  for (const FatBody& b : models) states.push_back(tissue::rest_state(b.fat));
  return states;
}

Fat::Work Fat::make_work(const Models& models, int) {
  Work w;
  for (const FatBody& b : models) {
    FatBodyWork& one = w.emplace_back();
    one.fat = tissue::make_work(b.fat);
    one.loads.reserve(kLoadsPerLobule * size_t(b.fat.lobules()));
  }
  return w;
}

void Fat::clear(Work& work) noexcept {
  for (FatBodyWork& w : work) w.loads.clear();
}

void Fat::touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept {
  for (size_t i = 0; i < models.size(); ++i) {
    const tissue::FatModel& m = models[i].fat;
    if (!is_near(m, states[i], hand.touching.shape)) continue;
    for (int part = kShaft; part < end_of(hand.touching.shape); part = next(part))
      touch_part(m, states[i], BodyId(kKind, i), hand, part, work[i].loads);
  }
}

Vec3d Fat::middle(const Models& models, const States& states, size_t i) noexcept {
  const tissue::FatModel& m = models[i].fat;
  Vec3d sum;
  for (int n = 0; n < m.lobules(); ++n) sum += tissue::position(m, states[i], n);
  return sum / double(std::max(1, m.lobules()));
}

double Fat::thickness(const FatBody& body) noexcept { return 2 * kFatCompressed * body.fat.radius; }

tissue::StepReport Fat::advance(const Models& models, Vec3d, double, const tissue::Box& cavity, States& states,
                                Work& work) noexcept {
  tissue::StepReport report;
  for (size_t i = 0; i < models.size(); ++i) {
    const tissue::FatModel& m = models[i].fat;
    FatBodyWork& w = work[i];
    stay(states[i], w.loads);
    w.loads.sort();
    const tissue::StepReport r = tissue::advance(m, w.loads.sorted, w.loads.reaction, states[i], w.fat);
    keep_in(cavity, m, states[i]);
    if (r.fine() || !report.fine()) continue;
    report = r;
    report.first_bad = int(i);
  }
  return report;
}

bool Fat::overloaded(const Work& work) noexcept {
  return std::any_of(work.begin(), work.end(), [](const FatBodyWork& w) { return w.loads.overflowed; });
}

bool Fat::hides(const Models& models, const States& states, Vec3d from, Vec3d to) noexcept {
  const collision::Capsule sight{from, to, 0};
  for (size_t i = 0; i < models.size(); ++i) {
    const tissue::FatModel& m = models[i].fat;
    for (int n = 0; n < m.lobules(); ++n) {
      if (states[i].lobules[size_t(n)].gone()) continue;
      const Vec3d p = tissue::position(m, states[i], n), off = p - collision::nearest_on_axis(sight, p);
      if (dot(off, off) < m.radius * m.radius) return true;
    }
  }
  return false;
}

bool Fat::is_valid(const States& states) noexcept {
  for (const tissue::FatState& s : states)
    for (const tissue::NodeState& n : s.network.nodes)
      if (!(std::fabs(n.x) < 10 && std::fabs(n.y) < 10 && std::fabs(n.z) < 10)) return false;
  return true;
}

void Fat::blend(const States& a, const States& b, double f, States& out) noexcept {
  const auto mixed = [f](float from, float to) { return from + float(f) * (to - from); };
  for (size_t i = 0; i < out.size(); ++i)
    for (size_t n = 0; n < out[i].network.nodes.size(); ++n) {
      const tissue::NodeState &from = a[i].network.nodes[n], &to = b[i].network.nodes[n];
      tissue::NodeState& at = out[i].network.nodes[n];
      at.x = mixed(from.x, to.x), at.y = mixed(from.y, to.y), at.z = mixed(from.z, to.z);
    }
}

}  // namespace trocar::interactions
