#include <algorithm>
#include <cmath>

#include <trocar/attempt/box/box_playback.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::attempt {
namespace {

constexpr double kWave = 0.1;               // [Hz] of the slowest
constexpr std::uint64_t kTellEvery = 1000;  // ticks

}  // namespace

BoxPlayback::BoxPlayback(const sim::Model& model, const devices::BoxWiring& wiring, std::vector<sim::Input> inputs,
                         double lead_in)
    : m_hands(model, wiring), m_inputs(std::move(inputs)), m_lead_in(lead_in) {
  for (const sim::HandModel& hand : model.hands) m_rack.push_back(int(hand.rack.size()));
  for (const sim::Input& input : m_inputs) {
    const devices::BoxAngles beyond = m_hands.beyond(input);
    for (std::size_t actor = 0; actor < devices::kBoxActors; ++actor)
      for (std::size_t axis = 0; axis < devices::kBoxAxes; ++axis)
        m_beyond[actor][axis] = std::max(m_beyond[actor][axis], beyond[actor][axis]);
  }
  press_for_changes();
}

double BoxPlayback::duration() const { return m_lead_in + double(m_inputs.size()) * core::kTick; }

/// A hand that takes another instrument presses its button until that one's turn has come.
void BoxPlayback::press_for_changes() {
  for (int actor = 0; actor < devices::kBoxHands; ++actor) {
    const int hand = m_hands.hand_of(devices::BoxActor(actor));
    const int bit = m_hands.wiring().buttons[std::size_t(actor)][std::size_t(devices::BoxButton::next_instrument)];
    if (hand < 0 || bit < 0) continue;
    const int count = m_rack[std::size_t(hand)];
    int now = 0;
    double free = 0;
    for (std::size_t tick = 0; tick < m_inputs.size(); ++tick) {
      const int wanted = m_inputs[tick].tools[hand].instrument;
      for (; now != wanted && wanted >= 0 && wanted < count; now = (now + 1) % count) {
        free = std::max(free, m_lead_in + double(tick) * core::kTick);
        m_presses.push_back({free, bit});
        free += 2 * kPress;
      }
    }
  }
  std::sort(m_presses.begin(), m_presses.end(), [](const Press& a, const Press& b) { return a.from < b.from; });
}

devices::BoxBlock BoxPlayback::at(double seconds) const {
  const double tick = std::clamp((seconds - m_lead_in) / core::kTick, 0.0, double(m_inputs.size() - 1));
  devices::BoxBlock block = m_hands.block_of(m_inputs[std::size_t(tick)]);
  const auto first = std::upper_bound(m_presses.begin(), m_presses.end(), seconds - kPress,
                                      [](double t, const Press& p) { return t < p.from; });
  for (auto p = first; p != m_presses.end() && p->from <= seconds; ++p) block.digital ^= 1u << p->bit;
  return block;
}

std::vector<sim::Input> inputs_of_demonstration(const Lesson& lesson, const std::function<bool(double)>& told) {
  const std::unique_ptr<InputSource> surgeon = lesson.surgeon();
  Session session(lesson);
  std::vector<sim::Input> inputs;
  sim::Input input = lesson.model.start;
  while (session.broken().empty() && inputs.size() < sim::kMaxTicks && surgeon->next(session.state(), input)) {
    surgeon->after(session.state(), session.advance(input));
    inputs.push_back(input);
    if (told && session.state().tick % kTellEvery == 0 && !told(double(session.state().tick) * core::kTick)) break;
  }
  if (inputs.empty()) throw core::BadInput({{{lesson.name, 0, 0}, "expected a demonstration that does something"}});
  return inputs;
}

std::vector<sim::Input> inputs_of_motion(const Lesson& lesson, const std::string& motion) {
  MotionSource source(lesson.model, motion);
  const sim::State resting = sim::initial_state(lesson.model);  // it does not look
  std::vector<sim::Input> inputs;
  sim::Input input = lesson.model.start;
  while (inputs.size() < sim::kMaxTicks && source.next(resting, input)) inputs.push_back(input);
  return inputs;
}

std::vector<sim::Input> waving_inputs(const sim::Model& model) {
  std::vector<sim::Input> inputs;
  for (int tick = 0; tick < 40'000; ++tick) {
    sim::Input input = model.start;
    const double phase = 2 * portable::pi * kWave * double(tick) * core::kTick;
    const auto wave = [phase](int number) { return float(portable::sin(phase * (1 + 0.1 * number))); };
    for (int h = 0; h < int(model.hands.size()); ++h) {
      sim::ToolInput& tool = input.tools[h];
      tool.yaw += 0.1f * wave(h);
      tool.pitch += 0.1f * wave(h + 1);
      tool.roll += 0.5f * wave(h + 2);
      tool.depth -= 0.01f * (1 - wave(h + 3));
    }
    inputs.push_back(input);
  }
  return inputs;
}

devices::BoxBlock waving_block(const devices::BoxWiring& wiring, double seconds) {
  devices::BoxBlock block;
  for (const auto& actor : wiring.axes)
    for (const devices::WiredAxis& axis : actor) {
      if (axis.channel < 0) continue;
      const double low = axis.table.codes.front(), high = axis.table.codes.back();
      const double phase = 2 * portable::pi * kWave * (1 + 0.05 * axis.channel) * seconds;
      block.codes[std::size_t(axis.channel)] =
          std::uint16_t(std::lround(0.5 * (low + high) + 0.4 * (high - low) * portable::sin(phase)));
    }
  block.digital = wiring.inverted;
  return block;
}

}  // namespace trocar::attempt
