#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/haptics/haptic_hand.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::attempt {
namespace {

constexpr std::uint32_t kSqueezes = 1, kLocks = 2, kCoagulates = 4, kLifts = 8;
constexpr double kCloses = 1.6, kOpens = 4.0;  // [1/s] as other devices do (devices/mouse_keyboard.hpp)
constexpr double kTurnsBy = 1e-3;              // [rad] of the endoscope from which the device's axes follow

/// Turn about the way that the device points, forward at rest [rad].
double turn_of(const Quatd& q) { return 2 * portable::atan2(q.y, q.w); }

Json of_durations(const devices::Durations& d) {
  return {{"count", d.count()},
          {"p50_us", 1e6 * d.quantile(0.5)},
          {"p99_us", 1e6 * d.quantile(0.99)},
          {"p99.9_us", 1e6 * d.quantile(0.999)},
          {"longest_us", 1e6 * d.longest()}};
}

bool differ(const Mat3d& a, const Mat3d& b) {
  for (int i = 0; i < 3; ++i)
    if (length(a.column(i) - b.column(i)) > kTurnsBy) return true;
  return false;
}

}  // namespace

HapticHand::HapticHand(const sim::Model& model, int hand, std::unique_ptr<devices::HapticDevice> device, Pace pace,
                       const Feel& feel)
    : m_model(model), m_hand(hand), m_feel(feel), m_modeller(model, hand) {
  if (pace == Pace::own_loop) {
    m_loop = std::make_unique<devices::HapticLoop>(std::move(device));
  } else {
    m_device = std::move(device);
    m_renderer = std::make_unique<devices::ForceRenderer>(m_device->capabilities(), devices::ForceRenderer::Settings{});
  }
}

const devices::HapticCapabilities& HapticHand::can() const noexcept {
  return m_loop ? m_loop->capabilities() : m_device->capabilities();
}

/// Right, forward and up of the device are those of the picture.
Mat3d HapticHand::picture_axes(const sim::State& state) const noexcept {
  const kinematics::ScopeFrame view = sim::scope_of(m_model, state);
  return Mat3d::from_columns(view.right, view.forward, view.up);
}

/// Where the device is now is where the tip is now.
void HapticHand::take_place(const sim::State& state, Vec3d tip) noexcept {
  m_frame.axes = picture_axes(state);
  m_frame.scale = m_feel.scale;
  m_frame.middle = m_report.sample.position;
  m_frame.centre = tip;
  m_local.frame = m_frame;
}

/// The newest report; in step with ticks, one period more of the device.
bool HapticHand::hear(devices::HandReport& report) noexcept {
  if (m_loop) return m_loop->take(report);
  if (!m_device->read(report.sample)) return false;
  const devices::HapticForce force = m_renderer->force(report.sample, m_local, 0);
  m_device->write(force);
  report.force = force.force;
  report.share = m_renderer->share();
  report.damping = m_renderer->passivity().damping();
  report.turns = m_device->capabilities().turns;
  report.grips = m_device->capabilities().grips;
  return true;
}

void HapticHand::note(const devices::HandReport& report) noexcept {
  const double force = length(report.force);
  m_force.store(force, std::memory_order_relaxed);
  if (force > m_most.load(std::memory_order_relaxed)) m_most.store(force, std::memory_order_relaxed);
  m_lost.store(report.lost != 0, std::memory_order_relaxed);
  m_impulse += core::kTick * force;
  m_damped += report.damping > 0;
  ++m_ticks;
}

void HapticHand::move_handle(std::uint32_t switches, bool grips) noexcept {
  if ((switches & kLocks) != 0 && (m_switches & kLocks) == 0) m_locked = !m_locked;
  m_switches = switches;
  if (grips)
    m_handle = m_locked ? std::max(m_handle, m_report.sample.grip) : m_report.sample.grip;
  else if ((switches & kSqueezes) != 0)
    m_handle = std::min(1.0, m_handle + kCloses * core::kTick);
  else if (!m_locked)
    m_handle = std::max(0.0, m_handle - kOpens * core::kTick);
}

void HapticHand::lead(const sim::State& state, sim::Input& input) noexcept {
  sim::ToolInput& tool = input.tools[m_hand];
  const interactions::ToolModel& held = m_model.tool(state, size_t(m_hand));
  const kinematics::FulcrumPose given = pose_of(tool);
  const Vec3d told = kinematics::forward(held.port, given).tip;
  devices::HapticDevice& device = m_loop ? m_loop->device() : *m_device;
  if (m_placed && device.is_led()) device.lead(m_frame.to_device(told));
  const bool heard = hear(m_report);
  if (heard) note(m_report);
  if (!heard && !m_placed) {
    m_wanted = told;
    return;
  }
  const devices::HapticSample& sample = m_report.sample;
  const Vec3d is_at = sim::led_place(m_model, state, size_t(m_hand));
  const bool lifted = (sample.switches & kLifts) != 0, changed = m_changes != state.tools[size_t(m_hand)].changes;
  if (!m_placed) {
    take_place(state, told);
    m_wanted = told;
    m_first_turn = turn_of(sample.rotation);
    m_roll = given.roll;
  } else if (changed && !device.is_led()) {
    take_place(state, is_at);  // the new instrument is at the trocar: the hand brings it in from there
  } else if (lifted) {
    take_place(state, m_wanted);
  } else if (differ(m_frame.axes, picture_axes(state))) {
    take_place(state, m_wanted);
  }
  m_placed = true;
  m_changes = state.tools[size_t(m_hand)].changes;
  const double roll = m_report.turns != 0 ? m_roll - (turn_of(sample.rotation) - m_first_turn) : given.roll;
  const kinematics::FulcrumPose pose =
      kinematics::clamped(kinematics::inverse(held.port, m_frame.to_space(sample.position), roll), held.limits);
  m_wanted = m_frame.to_space(sample.position);
  move_handle(sample.switches, m_report.grips != 0);
  tool = sim::tool_input(pose, std::max(tool.handle, float(m_handle)), tool.instrument);
  if ((sample.switches & kCoagulates) != 0) input.pedals |= sim::kBlue;
}

void HapticHand::after(const sim::State& state) noexcept {
  const double seal = m_feel.seal_friction < 0 ? m_model.hands[size_t(m_hand)].seal_friction : m_feel.seal_friction;
  m_local = m_modeller.of(state, m_wanted, seal);
  m_local.frame = m_frame;
  if (m_loop && m_placed) m_loop->put(m_local);
}

Json HapticHand::describe() const {
  Json out{{"device", can().name},
           {"hand", m_model.hands[size_t(m_hand)].name},
           {"most_force_N", m_most.load()},
           {"impulse_Ns", m_impulse},
           {"damped_share", m_ticks > 0 ? double(m_damped) / double(m_ticks) : 0.0}};
  if (!m_loop) return out;
  out["real_time_priority"] = m_loop->real_time();
  out["missed_periods"] = m_loop->missed();
  out["period"] = of_durations(m_loop->periods());
  out["computing"] = of_durations(m_loop->computing());
  return out;
}

int haptic_hand_of(const sim::Model& model, const std::string& name, const std::string& option) {
  if (name.empty()) {
    if (model.hands.empty()) throw core::BadInput({{{option, 0, 0}, "expected a scene with instruments, got none"}});
    return HandPilot(model).both().pair[devices::kRight] % int(model.hands.size());
  }
  if (const int hand = model.hand_index(name); hand >= 0) return hand;
  std::string known;
  for (const sim::HandModel& h : model.hands) known += (known.empty() ? "" : ", ") + h.name;
  throw core::BadInput({{{option, 0, 0}, tr("expected one of {}, got '{}'", known, name)}});
}

}  // namespace trocar::attempt
