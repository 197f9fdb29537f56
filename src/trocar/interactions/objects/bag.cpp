#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/bag.hpp>

namespace trocar::interactions {
namespace {

constexpr size_t kPressesPerNode = 2;

bool within_reach(Vec3d p) noexcept { return std::fabs(p.x) < 10 && std::fabs(p.y) < 10 && std::fabs(p.z) < 10; }

Vec3d mixed(Vec3d a, Vec3d b, double f) noexcept { return a + f * (b - a); }

}  // namespace

Bag::States Bag::start(const Models& models) {
  States states;
  for (const BagModel& m : models.list) {
    BagState& s = states.emplace_back();
    s.x.resize(m.drawn.size());
    s.v.resize(m.drawn.size());
    s.points.resize(size_t(m.points));
    s.skins.resize(m.drawn.size());
  }
  return states;
}

Bag::Work Bag::make_work(const Models& models, int hands) {
  Work all;
  for (const BagModel& m : models.list) {
    BagWork& w = all.list.emplace_back();
    w.before.resize(m.drawn.size());
    w.normal.resize(m.drawn.size());
    w.bodies.resize(size_t(m.points));
    w.presses.reserve(kPressesPerNode * m.drawn.size());
    w.touches.reserve(2 * size_t(m.points));
    w.rods.reserve(size_t(hands) * kMostParts);
  }
  return all;
}

void Bag::clear(Work& work) noexcept {
  for (BagWork& w : work.list) {
    w.presses.clear();
    w.touches.clear();
    w.rods.clear();
    w.overflowed = false;
  }
}

void Bag::touch(const Models&, const States& states, const ObjectHand& hand, Work& work) noexcept {
  if (hand.tool.can().bag) return;
  for (size_t i = 0; i < states.size(); ++i)
    for (int part = kShaft; part < end_of(hand.touching.shape) && states[i].there(); part = next(part))
      work.list[i].rods.push_back({hand.touching.shape.rod(part)});
}

bool Bag::overloaded(const Work& work) noexcept {
  return std::any_of(work.list.begin(), work.list.end(), [](const BagWork& w) { return w.overflowed; });
}

bool Bag::is_valid(const States& states) noexcept {
  for (const BagState& s : states) {
    if (!(s.hoop >= 0 && s.hoop <= 1 && s.unrolled >= 0 && s.unrolled <= 1)) return false;
    if (!within_reach(s.frame.tip) || !within_reach(s.frame.axis) || !within_reach(s.frame.up)) return false;
    for (const Vec3d& p : s.x)
      if (!within_reach(p)) return false;
    for (const BagPoint& p : s.points)
      if (p.where < BagPoint::elsewhere || p.where > BagPoint::inside || p.node < 0 || size_t(p.node) >= s.x.size())
        return false;
  }
  return true;
}

void Bag::blend(const States& a, const States& b, double f, States& out) noexcept {
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].hoop = a[i].hoop + f * (b[i].hoop - a[i].hoop);
    out[i].frame.tip = mixed(a[i].frame.tip, b[i].frame.tip, f);
    out[i].frame.axis = normalised(mixed(a[i].frame.axis, b[i].frame.axis, f), a[i].frame.axis);
    out[i].frame.up = normalised(mixed(a[i].frame.up, b[i].frame.up, f), a[i].frame.up);
    for (size_t n = 0; n < out[i].x.size(); ++n) out[i].x[n] = mixed(a[i].x[n], b[i].x[n], f);
  }
}

}  // namespace trocar::interactions
