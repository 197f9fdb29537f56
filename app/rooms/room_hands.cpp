#include "rooms/room_hands.hpp"

#include <fmt/format.h>

#include <trocar/sim/model/seen.hpp>

namespace trocar::app {
namespace {

constexpr double kSamePort = 0.002;  // [m]
constexpr int kScopeHand = -1, kNobody = -2;

/// The scene's hand whose trocar is there.
int hand_at(const sim::Model& scene, Vec3d port) {
  for (std::size_t h = 0; h < scene.hands.size(); ++h)
    if (length(scene.hands[h].port - port) < kSamePort) return int(h);
  return length(scene.scope.port - port) < kSamePort ? kScopeHand : kNobody;
}

kinematics::TipFrame straight_scope(const sim::Model& scene, const sim::ScopeInput& scope) {
  return kinematics::forward(scene.scope.port, pose_of(scope));
}

}  // namespace

RoomHands::RoomHands(const studies::RoomModel& room, const sim::Model& scene) : m_room(room), m_scene(scene) {
  for (std::size_t a = 0; a < room.arms().size(); ++a)
    if (const int hand = hand_at(scene, room.arms()[a].port); hand != kNobody) m_links.push_back({int(a), hand});
  for (const scene::RoomInstrument& i : room.room().instruments)
    m_held.push_back(hand_at(scene, room.room().ports[std::size_t(room.room().port(i.port))].position));
}

studies::ArmGoal RoomHands::goal(const Link& link, const sim::Input& input) const {
  if (link.hand == kScopeHand) {
    const kinematics::TipFrame tip = straight_scope(m_scene, input.scope);
    return {tip.tip, true, tip.rotation};
  }
  const auto hand = std::size_t(link.hand);
  const kinematics::TipFrame tip = kinematics::forward(m_scene.hands[hand].port, pose_of(input.tools[hand]));
  const sim::WristInput& bent = input.wrists[hand];
  if (bent.pitch == 0 && bent.yaw == 0) return {tip.tip, true, tip.rotation};
  const kinematics::TipFrame led =
      kinematics::led(m_scene.hands[hand].port, pose_of(input.tools[hand]), double(bent.pitch), double(bent.yaw));
  return {led.tip, true, led.rotation};
}

studies::ArmGoal RoomHands::goal(const Link& link, const sim::State& state) const {
  const kinematics::TipFrame tip = link.hand == kScopeHand ? straight_scope(m_scene, state.scope)
                                                           : sim::tip_frame_of(m_scene, state, std::size_t(link.hand));
  return {tip.tip, true, tip.rotation};
}

template <class Where>
std::vector<Vec3d> RoomHands::tips_of(Where where) const {
  std::vector<Vec3d> tips;
  for (std::size_t i = 0; i < m_held.size(); ++i)
    tips.push_back(m_held[i] == kNobody ? m_room.room().instruments[i].tip : where(Link{-1, m_held[i]}).tip);
  return tips;
}

std::vector<Vec3d> RoomHands::tips(const sim::Input& input) const {
  return tips_of([&](const Link& link) { return goal(link, input); });
}
std::vector<Vec3d> RoomHands::tips(const sim::State& state) const {
  return tips_of([&](const Link& link) { return goal(link, state); });
}

std::string RoomHands::known() const {
  std::string out;
  for (const sim::HandModel& hand : m_scene.hands)
    out += fmt::format("{}{} ({:.0f}, {:.0f}, {:.0f})", out.empty() ? "" : "; ", hand.name, 1e3 * hand.port.x,
                       1e3 * hand.port.y, 1e3 * hand.port.z);
  return out;
}

}  // namespace trocar::app
