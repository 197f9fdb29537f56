#include <algorithm>
#include <utility>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::attempt {
namespace {

constexpr double kLeash = 0.02;         // [m] a command runs ahead of the instrument by no more
constexpr double kTimeConstant = 0.01;  // [s] of the smoothing
constexpr double kParked = 0.010;       // [m] a changed instrument waits this deep, in the trocar's sleeve
constexpr double kInsertSpeed = 0.06;   // [m/s]
constexpr double kInView = 0.012;       // [m] an instrument that comes into the view continues for this long
constexpr double kHollow = 0.040;       // [m] as deep as an instrument goes in by itself without being seen

std::array<float, 3> as_array(Vec3d v) { return {float(v.x), float(v.y), float(v.z)}; }

std::uint32_t pedals_of(const devices::HandCommand& command) {
  std::uint32_t pedals = (command.wipe ? sim::kWipe : 0u) | (command.blue ? sim::kBlue : 0u);
  if (command.declare) pedals |= sim::kDeclare;
  if (command.yellow) pedals |= sim::kYellow;
  if (command.irrigate) pedals |= sim::irrigates(command.led);
  if (command.suck) pedals |= sim::sucks(command.led);
  return pedals;
}

Vec3d as_vector(const std::array<float, 3>& a) { return {double(a[0]), double(a[1]), double(a[2])}; }

}  // namespace

HandPilot::HandPilot(const sim::Model& model) : m_model(model), m_input(model.start) {
  m_settings.instruments = int(model.hands.size());
  if (model.hands.empty()) m_hands.state.led = devices::kScope;
  for (std::size_t t = 0; t < model.hands.size(); ++t) {
    m_hands.state.handle[t] = model.start.tools[t].handle;
    m_hands.state.ratchet[t] = model.start.tools[t].handle == 1;  // an assistant who holds something
  }
  m_hands.pair = sides_of(model);
}

void HandPilot::set(const devices::HandSettings& settings) {
  const int instruments = m_settings.instruments;
  m_settings = settings;
  m_settings.instruments = instruments;
}

void HandPilot::choose(int hand) {
  if (hand == devices::kScope || (hand >= 0 && hand < int(m_model.hands.size())))
    devices::choose(m_settings, hand, m_hands);
}

bool HandPilot::changing(int hand, const sim::State& state) const {
  return m_input.tools[hand].instrument != state.tools[size_t(hand)].instrument;
}

void HandPilot::take(int instrument) {
  const int hand = hands().led;
  if (hand == devices::kScope || instrument < 0 || instrument >= int(m_model.hands[size_t(hand)].rack.size())) return;
  if (m_input.tools[hand].instrument == instrument) return;
  m_input.tools[hand].instrument = instrument;
  m_input.tools[hand].depth = float(kParked);
  m_input.wrists[hand] = {};
  m_hands.state.handle[size_t(hand)] = 0;
  m_hands.state.ratchet[size_t(hand)] = false;
  m_inserting[size_t(hand)] = false;
}

/// Who is meant to come into the view: the led one; one that waits in its trocar before one that is in already.
int HandPilot::waiting(int led, const sim::State& state) const {
  const auto waits = [&](int h) { return state.tools[size_t(h)].depth < 3 * kParked; };
  if (led == devices::kScope || waits(led)) return led;
  for (int h = 0; h < int(m_model.hands.size()); ++h)
    if (waits(h) && (h == m_hands.pair[0] || h == m_hands.pair[1]) && leads_both()) return h;
  return led;
}

void HandPilot::insert(int hand) {
  if (hand != devices::kScope) m_inserting[size_t(hand)] = true;
}

const sim::Input& HandPilot::lead(const devices::HandSample& sample, const sim::State& state) {
  for (int h = 0; h < hand_count(m_model); ++h) {
    m_hands.state.valves[size_t(h)] = has_valves(m_model, state, h);
    m_hands.state.needle[size_t(h)] = held_by(m_model, state, h).can().inject;
    m_hands.state.electrode[size_t(h)] = is_bare_electrode(m_model, state, h);
    m_hands.state.wrist[size_t(h)] = h < int(m_model.hands.size()) && m_model.tool(state, size_t(h)).bends.bends();
  }
  const kinematics::ScopeFrame view = sim::scope_of(m_model, state);
  m_asks_for_rack = false;
  m_input.pedals = take_panel_keys();
  for (const devices::HandCommand& command : devices::lead(m_settings, sample, m_hands)) {
    if (command.insert) insert(waiting(command.led, state));
    if (command.led == devices::kScope)
      move_scope(command.scope, view);
    else if (command.led < int(m_model.hands.size()))
      move_tool(command, view, state);
    m_input.pedals |= pedals_of(command);
    m_asks_for_rack |= command.rack;
  }
  go_on(sample.dt, state);
  return m_input;
}

const sim::Input& HandPilot::rest(float dt, const sim::State& state) {
  m_input.pedals = take_panel_keys();
  go_on(dt, state);
  return m_input;
}

std::uint32_t HandPilot::take_panel_keys() { return std::exchange(m_panel_keys, 0) << sim::kPanelBit; }

void HandPilot::go_on(float dt, const sim::State& state) {
  for (int h = 0; h < int(m_model.hands.size()); ++h) {
    if (m_inserting[size_t(h)]) move_in(h, std::min(dt, 0.1f), state);
    m_input.tools[h].handle = m_hands.state.handle[size_t(h)];
  }
}

/// Along the shaft as it was placed, until both jaws have been in view for a while or the placed depth is reached: it
/// was chosen clear of all tissue.
void HandPilot::move_in(int hand, float dt, const sim::State& state) {
  m_unseen[size_t(hand)] = false;
  if (changing(hand, state)) return;
  sim::ToolInput& input = m_input.tools[hand];
  const sim::ToolInput& placed = m_model.start.tools[hand];
  const interactions::ToolState& tool = state.tools[size_t(hand)];
  if (tool.depth < 2 * kParked) input.yaw = placed.yaw, input.pitch = placed.pitch;
  const std::string& name = m_model.hands[size_t(hand)].name;
  const auto shows = [&](const char* part) { return sim::visible(m_model, state, m_model.target_index(name + part)); };
  const bool seen = shows(".jaw_a") && shows(".jaw_b");
  const bool noticed = seen || shows(".jaw_a") || shows(".jaw_b") || shows(".shaft");
  const double left = seen ? std::min(kInView, double(placed.depth - input.depth)) : double(placed.depth - input.depth);
  const bool ahead = double(input.depth) - tool.depth > kLeash;  // it meets something: do not push on
  if (left <= 0 || (seen && tool.depth > 3 * kParked)) {
    m_inserting[size_t(hand)] = false;
    return;
  }
  m_unseen[size_t(hand)] = !noticed && double(input.depth) >= kHollow;
  if (!ahead && !m_unseen[size_t(hand)]) input.depth += float(std::min(left, kInsertSpeed * double(dt)));
}

void HandPilot::move_tool(const devices::HandCommand& command, const kinematics::ScopeFrame& view,
                          const sim::State& state) {
  if (changing(command.led, state)) return;
  const interactions::ToolModel& tool = m_model.tool(state, size_t(command.led));
  sim::ToolInput& input = m_input.tools[command.led];
  const bool moved = command.tip.right != 0 || command.tip.up != 0 || command.tip.in != 0;
  if (m_inserting[size_t(command.led)] && !moved) return;
  m_inserting[size_t(command.led)] = false;
  // Of an instrument that bends, too, the straight one's tip is controlled; a redundant one's has another pose for it.
  const Vec3d is_at = sim::led_place(m_model, state, size_t(command.led));
  const kinematics::TipFrame commanded = kinematics::forward(tool.port, pose_of(input));
  Vec3d tip = commanded.tip + as_vector(devices::in_space(command.tip, as_array(view.right), as_array(view.up),
                                                          as_array(commanded.axis())));
  const double ahead = length(tip - is_at);
  if (ahead > kLeash) tip = is_at + (kLeash / ahead) * (tip - is_at);
  if (tool.bends.bends()) bend_tool(command.wrist, tool, commanded, view, m_input.wrists[command.led]);
  // Clockwise as the hand sees it is against the sense of the fulcrum's roll, whose axis points back to the hand.
  const double roll = double(input.roll) - double(command.roll);
  input = sim::tool_input(kinematics::clamped(kinematics::inverse(tool.port, tip, roll), tool.limits), input.handle,
                          input.instrument);
}

/// Up in the picture is up, however the instrument is rolled.
void HandPilot::bend_tool(const devices::WristMotion& motion, const interactions::ToolModel& tool,
                          const kinematics::TipFrame& straight, const kinematics::ScopeFrame& view,
                          sim::WristInput& wrist) {
  constexpr double kMostTurned = 1.4;  // [rad] of a redundant instrument's tip
  if (motion.straighten) {
    wrist = {};
    return;
  }
  const Vec3d way = double(motion.right) * view.right + double(motion.up) * view.up;
  const auto within = [&](int joint, double angle) {
    const kinematics::Articulation& bends = tool.bends;
    if (bends.redundant()) return float(std::clamp(angle, -kMostTurned, kMostTurned));
    return joint < bends.joints ? float(std::clamp(angle, bends.low[joint], bends.high[joint])) : 0.0f;
  };
  wrist.pitch = within(0, double(wrist.pitch) + dot(way, straight.normal()));
  wrist.yaw = within(1, double(wrist.yaw) - dot(way, straight.opening()));
}

void HandPilot::move_scope(const devices::ScopeMotion& motion, const kinematics::ScopeFrame& view) {
  sim::ScopeInput& scope = m_input.scope;
  const Vec3d port = m_model.scope.port;
  const Vec3d axis = kinematics::forward(port, pose_of(scope)).axis();
  // The view turns by a small rotation about the trocar; an oblique lens turns with its shaft.
  const Vec3d turn = double(motion.up) * view.right - double(motion.right) * view.up;
  const Vec3d turned = normalised(axis + cross(turn, axis));
  const double depth = double(scope.depth) + double(motion.in);
  const double roll = double(scope.roll) - double(motion.head);  // the picture turns against the camera head
  const kinematics::FulcrumPose pose = kinematics::clamped(
      kinematics::inverse(port, port + std::max(depth, m_model.scope.limits.depth_min) * turned, roll),
      m_model.scope.limits);
  scope = {float(pose.yaw), float(pose.pitch), float(pose.roll), float(pose.depth), scope.post + motion.post};
}

namespace {

/// The scope's five coordinates, then each hand's five, then their wrists' two.
template <class Input, class F>
void for_coordinates(Input& input, F&& f) {
  for (auto* c : {&input.scope.yaw, &input.scope.pitch, &input.scope.roll, &input.scope.depth, &input.scope.post})
    f(*c);
  for (auto& t : input.tools)
    for (auto* c : {&t.yaw, &t.pitch, &t.roll, &t.depth, &t.handle}) f(*c);
  for (auto& w : input.wrists)
    for (auto* c : {&w.pitch, &w.yaw}) f(*c);
}

}  // namespace

SmoothInput::SmoothInput(const sim::Input& start) {
  std::size_t i = 0;
  for_coordinates(start, [&](float now) {
    m_follower.mid[i] = m_follower.x[i] = double(now);
    ++i;
  });
}

sim::Input SmoothInput::step(const sim::Input& target) {
  std::array<double, kCoordinates> wanted;
  std::size_t i = 0;
  for_coordinates(target, [&](float to) { wanted[i++] = double(to); });
  devices::follow(m_follower, wanted, devices::follower_gain(sim::kTick, kTimeConstant));
  sim::Input out = target;
  i = 0;
  for_coordinates(out, [&](float& now) { now = float(m_follower.x[i++]); });
  return out;
}

}  // namespace trocar::attempt
