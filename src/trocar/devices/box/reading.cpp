#include <algorithm>
#include <cmath>

#include <trocar/devices/box/reading.hpp>

namespace trocar::devices {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kSpeedCorner = 5;  // [Hz] of the filter's own idea of speed
constexpr double kLongest = 0.25;   // [s] between blocks; beyond, a filter restarts
constexpr std::array<double, kBoxAxes> kFastest = {12, 12, 20, 1.5, 20};  // [rad/s], [m/s], [1/s]: no hand is faster

double gain(double corner, double dt) { return dt / (dt + 1 / (kTwoPi * corner)); }

}  // namespace

double OneEuro::next(double value, double dt, double rest, double per_speed) noexcept {
  if (!m_begun || !(rest > 0) || dt > kLongest) {
    m_value = value;
    m_speed = 0;
    m_begun = true;
    return value;
  }
  if (!(dt > 0)) return m_value;
  m_speed += gain(kSpeedCorner, dt) * ((value - m_value) / dt - m_speed);
  m_value += gain(rest + per_speed * std::abs(m_speed), dt) * (value - m_value);
  return m_value;
}

std::uint32_t Debounce::next(std::uint32_t bits, BoxTime at, bool checked) noexcept {
  const std::uint32_t agreed = checked || !m_begun ? ~0u : ~(bits ^ m_last);
  m_last = bits;
  if (!m_begun) {
    m_begun = true;
    return m_bits = bits;
  }
  for (int bit = 0; bit < kBoxDigitalBits; ++bit) {
    const std::uint32_t mask = 1u << bit;
    if (((bits ^ m_bits) & agreed & mask) == 0 || at - m_changed[std::size_t(bit)] < kBounce) continue;
    m_bits ^= mask;
    m_changed[std::size_t(bit)] = at;
  }
  return m_bits;
}

double unwrapped(double angle, double before) noexcept {
  return angle + kTwoPi * std::round((before - angle) / kTwoPi);
}

const BoxPose& BoxReader::read(const BoxPacket& packet) noexcept {
  const double dt = m_pose.number == 0 ? 0 : box_seconds(packet.acquired - m_pose.acquired);
  m_pose.wired = 0;
  for (std::size_t actor = 0; actor < kBoxActors; ++actor)
    for (std::size_t axis = 0; axis < kBoxAxes; ++axis) {
      const WiredAxis& wired = m_wiring.axes[actor][axis];
      if (wired.channel < 0 || (packet.mask >> wired.channel & 1) == 0) continue;
      double value = wired.table.value(packet.block.codes[std::size_t(wired.channel)]);
      if (BoxActor(actor) == BoxActor::scope && BoxAxis(axis) == BoxAxis::handle)
        value = m_post = unwrapped(value, m_post);
      m_pose.axes[actor][axis] =
          m_filters[actor][axis].next(value, dt, m_wiring.filter.rest, m_wiring.filter.per_speed[axis]);
      m_pose.wired |= 1u << (kBoxAxes * actor + axis);
    }
  read_bits(m_debounce.next(packet.block.digital ^ m_wiring.inverted, packet.acquired, packet.checked));
  m_pose.acquired = packet.acquired;
  m_pose.arrived = packet.arrived;
  m_pose.block = packet.block;
  ++m_pose.number;
  return m_pose;
}

void BoxReader::read_bits(std::uint32_t bits) noexcept {
  const auto down = [bits](int bit) { return bit >= 0 && (bits >> bit & 1) != 0; };
  m_pose.pedals = 0;
  for (int pedal = 0; pedal < kBoxPedals; ++pedal)
    if (down(m_wiring.pedals[std::size_t(pedal)])) m_pose.pedals |= 1u << pedal;
  for (std::size_t hand = 0; hand < kBoxHands; ++hand) {
    const auto& buttons = m_wiring.buttons[hand];
    m_pose.valves[hand] =
        std::uint8_t((down(buttons[int(BoxButton::irrigate)]) ? 1 : 0) | (down(buttons[int(BoxButton::suck)]) ? 2 : 0));
    const std::uint32_t mask = 1u << hand;
    const bool next = down(buttons[int(BoxButton::next_instrument)]);
    // What is down in the very first block was not pressed for us.
    if (next && (m_pressed & mask) == 0 && m_pose.number > 0) ++m_pose.changes[hand];
    m_pressed = next ? m_pressed | mask : m_pressed & ~mask;
  }
}

const char* name_of(BoxFreshness freshness) {
  switch (freshness) {
    case BoxFreshness::measured:
      return "measured";
    case BoxFreshness::extrapolated:
      return "extrapolated";
    case BoxFreshness::held:
      return "held";
    case BoxFreshness::frozen:
      break;
  }
  return "frozen";
}

void BoxBridge::take(const BoxPose& pose) noexcept {
  const double dt = box_seconds(pose.acquired - m_new.acquired);
  m_speed = {};
  if (any() && dt > 0 && dt < kLongest)
    for (std::size_t actor = 0; actor < kBoxActors; ++actor)
      for (std::size_t axis = 0; axis < kBoxAxes; ++axis)
        m_speed[actor][axis] =
            std::clamp((pose.axes[actor][axis] - m_new.axes[actor][axis]) / dt, -kFastest[axis], kFastest[axis]);
  m_new = pose;
}

const BoxPose& BoxBridge::at(BoxTime now) noexcept {
  m_out = m_new;
  // The next block is due a period after this one arrived, and half a period later it is missing.
  const BoxTime late = now - m_new.arrived - m_period * 3 / 2;
  if (!any() || late >= kHeldBlocks * m_period) {
    m_freshness = BoxFreshness::frozen;
    m_out.pedals = 0;
    m_out.valves = {};
  } else {
    m_freshness = late < 0               ? BoxFreshness::measured
                  : late < kExtrapolated ? BoxFreshness::extrapolated
                                         : BoxFreshness::held;
  }
  if (late <= 0 || !any()) return m_out;
  const double on = box_seconds(std::min(late, kExtrapolated));
  for (std::size_t actor = 0; actor < kBoxActors; ++actor)
    for (std::size_t axis = 0; axis < kBoxAxes; ++axis) m_out.axes[actor][axis] += on * m_speed[actor][axis];
  return m_out;
}

}  // namespace trocar::devices
