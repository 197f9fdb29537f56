#include <algorithm>
#include <cmath>

#include <trocar/attempt/box/box_hands.hpp>

namespace trocar::attempt {

using devices::BoxActor;
using devices::BoxAxis;

namespace {

/// Of a hand or the endoscope, by the box's axis; the endoscope's last one is its light post.
template <class Input>
auto& coordinate(Input& input, int hand, BoxAxis axis) {
  auto& scope = input.scope;
  auto& tool = input.tools[std::max(0, hand)];
  const bool is_scope = hand < 0;
  switch (axis) {
    case BoxAxis::yaw:
      return is_scope ? scope.yaw : tool.yaw;
    case BoxAxis::pitch:
      return is_scope ? scope.pitch : tool.pitch;
    case BoxAxis::roll:
      return is_scope ? scope.roll : tool.roll;
    case BoxAxis::depth:
      return is_scope ? scope.depth : tool.depth;
    case BoxAxis::handle:
      break;
  }
  return is_scope ? scope.post : tool.handle;
}

constexpr int kScope = -1;

constexpr std::pair<devices::BoxPedal, std::uint32_t> kPedals[] = {{devices::kBoxCoagulate, sim::kBlue},
                                                                   {devices::kBoxCut, sim::kYellow},
                                                                   {devices::kBoxWipe, sim::kWipe},
                                                                   {devices::kBoxDeclare, sim::kDeclare}};

}  // namespace

BoxHands::BoxHands(const sim::Model& model, const devices::BoxWiring& wiring) : m_model(model), m_wiring(wiring) {
  const auto hands = int(model.hands.size());
  for (int h = 0; h < devices::kBoxHands; ++h) m_hand[std::size_t(h)] = h < hands ? h : -1;
  m_hand[std::size_t(BoxActor::scope)] = kScope;
  if (hands >= 2) {  // left is whose trocar lies further to the left of the picture, as placed
    const Vec3d right =
        kinematics::scope_frame(model.scope.port, pose_of(model.start.scope), model.scope.angle, model.start.scope.post)
            .right;
    if (dot(model.hands[0].port - model.hands[1].port, right) >= 0) std::swap(m_hand[0], m_hand[1]);
  }
  for (int h = 0; h < devices::kBoxHands; ++h)
    if (!wiring.has(BoxActor(h))) m_hand[std::size_t(h)] = -1;
}

/// Calls f(hand or kScope, actor, axis, wired axis) for all that is wired and there.
template <class F>
void BoxHands::for_wired(F&& f) const {
  for (int actor = 0; actor < devices::kBoxActors; ++actor) {
    const int hand = m_hand[std::size_t(actor)];
    if (BoxActor(actor) != BoxActor::scope && hand < 0) continue;
    for (int axis = 0; axis < devices::kBoxAxes; ++axis)
      if (const devices::WiredAxis& wired = m_wiring.axis(BoxActor(actor), BoxAxis(axis)); wired.channel >= 0)
        f(hand, BoxActor(actor), BoxAxis(axis), wired);
  }
}

/// What the scene's coordinate is where the box says 0.
double BoxHands::zero(BoxActor actor, BoxAxis axis) const {
  const bool counts = axis == BoxAxis::depth || (axis == BoxAxis::handle && actor != BoxActor::scope);
  if (!m_wiring.from_placed || counts) return 0;
  return double(coordinate(m_model.start, m_hand[std::size_t(actor)], axis));
}

void BoxHands::lead(const devices::BoxPose& pose, sim::Input& input) const {
  for_wired([&](int hand, BoxActor actor, BoxAxis axis, const devices::WiredAxis&) {
    if (pose.has(actor, axis)) coordinate(input, hand, axis) = float(zero(actor, axis) + pose.of(actor, axis));
  });
  input.pedals = 0;
  for (const auto& [pedal, bit] : kPedals)
    if ((pose.pedals & pedal) != 0) input.pedals |= bit;
  for (int h = 0; h < devices::kBoxHands; ++h) {
    const int hand = m_hand[std::size_t(h)];
    if (hand < 0) continue;
    sim::ToolInput& tool = input.tools[hand];
    tool = sim::tool_input(kinematics::clamped(pose_of(tool), m_model.placed(std::size_t(hand)).limits),
                           std::clamp(tool.handle, 0.0f, 1.0f), tool.instrument);
    const unsigned valves = pose.valves[std::size_t(h)];
    input.pedals |= ((valves & 1) != 0 ? sim::irrigates(hand) : 0u) | ((valves & 2) != 0 ? sim::sucks(hand) : 0u);
  }
  const kinematics::FulcrumPose scope = kinematics::clamped(pose_of(input.scope), m_model.scope.limits);
  input.scope = {float(scope.yaw), float(scope.pitch), float(scope.roll), float(scope.depth), input.scope.post};
}

/// What the box's axis says then; the light post's within one turn.
double BoxHands::deflection(const sim::Input& input, int hand, BoxActor actor, BoxAxis axis) const {
  const double value = double(coordinate(input, hand, axis)) - zero(actor, axis);
  return actor == BoxActor::scope && axis == BoxAxis::handle ? devices::unwrapped(value, 0) : value;
}

devices::BoxBlock BoxHands::block_of(const sim::Input& input) const {
  devices::BoxBlock block;
  for_wired([&](int hand, BoxActor actor, BoxAxis axis, const devices::WiredAxis& wired) {
    const double code = wired.table.code(deflection(input, hand, actor, axis));
    block.codes[std::size_t(wired.channel)] =
        std::uint16_t(std::lround(std::clamp(code, 0.0, double(devices::kBoxTopCode))));
  });
  const auto press = [&block](int bit) {
    if (bit >= 0) block.digital |= 1u << bit;
  };
  for (std::size_t p = 0; p < std::size(kPedals); ++p)
    if ((input.pedals & kPedals[p].second) != 0) press(m_wiring.pedals[p]);
  for (int h = 0; h < devices::kBoxHands; ++h) {
    const int hand = m_hand[std::size_t(h)];
    if (hand < 0) continue;
    const auto& buttons = m_wiring.buttons[std::size_t(h)];
    if ((input.pedals & sim::irrigates(hand)) != 0) press(buttons[std::size_t(devices::BoxButton::irrigate)]);
    if ((input.pedals & sim::sucks(hand)) != 0) press(buttons[std::size_t(devices::BoxButton::suck)]);
  }
  block.digital ^= m_wiring.inverted;
  return block;
}

devices::BoxAngles BoxHands::beyond(const sim::Input& input) const {
  devices::BoxAngles all{};
  for_wired([&](int hand, BoxActor actor, BoxAxis axis, const devices::WiredAxis& wired) {
    const double value = deflection(input, hand, actor, axis);
    const double code = wired.table.code(value);
    if (code < 0 || code > devices::kBoxTopCode)
      all[std::size_t(actor)][std::size_t(axis)] =
          std::abs(value - wired.table.value(std::clamp(code, 0.0, double(devices::kBoxTopCode))));
  });
  return all;
}

}  // namespace trocar::attempt
