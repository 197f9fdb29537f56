#include <algorithm>
#include <cmath>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe_check.hpp>
#include <trocar/sim/verbs/verbs.hpp>

namespace trocar::sim::keyframe {
namespace {

/// Of tissue, or a place that an object has.
bool can_be_held(const Model& model, const interactions::MaterialPoint& at) {
  const bool tissue = at.body.kind() <= BodyKind::membrane || at.body.is(BodyKind::fat);
  if (tissue) return is_valid(model, at) && !at.in_space();
  return at.element >= 0 && at.element < places_on(model, at.body);
}

bool sound(const Model& model, int rack, const interactions::ToolState& t) {
  for (double v : {t.yaw, t.pitch, t.roll, t.depth, t.aperture, t.handle})
    if (!(std::fabs(v) < 1e3)) return false;
  if (t.instrument < 0 || t.instrument >= rack) return false;
  if (t.holds < 0 || t.holds > interactions::kMaxHolds) return false;
  for (int i = 0; i < t.holds; ++i)
    if (!can_be_held(model, t.hold[i].at)) return false;
  return true;
}

/// Nowhere, or a point of an organ.
bool is_on_organ(const Model& model, const interactions::MaterialPoint& point) {
  return is_valid(model, point) && (point.in_space() || point.body.is(BodyKind::organ));
}

/// A needle is in nothing, or in a lattice at places of its skin.
bool sound(const Model& model, const NeedleHand& hand) {
  for (const double v : {hand.at.x, hand.at.y, hand.at.z, hand.anchor, hand.depth, hand.press, hand.flow,
                         hand.tip_pressure, hand.plunger})
    if (!(std::fabs(v) < 1e9)) return false;
  if (hand.vessel < -1 || hand.vessel >= std::int32_t(model.vessels.list.size()) || hand.left < 0) return false;
  return is_on_organ(model, hand.entry) && is_on_organ(model, hand.touch);
}

}  // namespace

bool sound(const geometry::CuttableTets& b) {
  constexpr double least6 = 1e-16;  // [m^3]
  const auto cells = std::int32_t(b.cells.size());
  for (std::int32_t n = 0; n < b.nodes; ++n) {
    if (b.source[size_t(n)] < 0 || b.source[size_t(n)] > n) return false;
    for (int k = 0; k < 3; ++k)
      if (!(std::fabs(b.rest[size_t(n)][k]) < 1e3)) return false;
  }
  for (size_t c = 0; c < b.cells.size(); ++c)
    for (size_t k = 0; k < 4; ++k)
      if (b.cells[c][k] < 0 || b.cells[c][k] >= b.nodes || b.across[c][k] < -1 || b.across[c][k] >= cells) return false;
  for (size_t c = 0; c < b.cells.size(); ++c) {
    const auto x = [&](size_t k) { return b.rest[size_t(b.cells[c][k])]; };
    if (!(dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) > least6)) return false;
    for (const std::int32_t u : b.across[c]) {
      if (u < 0) continue;
      const geometry::Tet& back = b.across[size_t(u)];
      if (std::find(back.begin(), back.end(), std::int32_t(c)) == back.end()) return false;
    }
  }
  return true;
}

bool sound(const Model& model, const State& s) {
  for (size_t t = 0; t < s.tools.size(); ++t)
    if (!sound(model, t < model.hands.size() ? int(model.hands[t].rack.size()) : 1, s.tools[t])) return false;
  for (float v : {s.scope.yaw, s.scope.pitch, s.scope.roll, s.scope.depth, s.scope.post})
    if (!(std::fabs(v) < 1e3f)) return false;
  for (const kinematics::Joints& joints : s.joints)
    for (const double angle : joints.angle)
      if (!(std::fabs(angle) < 1e3)) return false;
  for (const kinematics::PortState& port : s.ports)
    for (int k = 0; k < 3; ++k)
      if (!(std::fabs(port.give[k]) < 1 && std::fabs(port.shift[k]) < 1)) return false;
  for (const std::vector<interactions::BondState>& bonds : s.bonds)
    for (const interactions::BondState& bond : bonds)
      if (!(bond.damage >= 0 && bond.damage <= 1)) return false;
  for (const NeedleHand& hand : s.injection.hands)
    if (!sound(model, hand)) return false;
  for (const tissue::InfusionState& organ : s.injection.organs)
    for (std::size_t r = 0; r < organ.dose.size(); ++r)
      if (!(organ.dose[r] >= 0 && organ.dose[r] < 1e6f) || organ.since[r] > s.tick + 1) return false;
  bool good = true;
  visit_record_buffers(model, s, [&](auto verb, auto buffer) {
    for (const auto& record : buffer.used()) good = good && verb.sound(model, record);
  });
  return good;
}

}  // namespace trocar::sim::keyframe
