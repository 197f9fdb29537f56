#include <cmath>

#include <trocar/devices/box/wiring.hpp>

namespace trocar::devices {
namespace {

/// The piece of `x` (rising or falling) in which `at` lies, continued at the ends, and the y there.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) noexcept {
  const bool rising = x.back() > x.front();
  std::size_t i = 1;
  while (i + 1 < x.size() && (rising ? at >= x[i] : at <= x[i])) ++i;
  return y[i - 1] + (at - x[i - 1]) * (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
}

// Between two rows of a table: what is steeper or flatter is no calibration.
constexpr double kLeastCodes = 1, kLeastStep = 1e-6;
constexpr double kPi = 3.14159265358979323846, kScopeReach = kPi * 85 / 180;

}  // namespace

double AxisTable::value(double code) const noexcept { return interpolated(codes, values, code); }
double AxisTable::code(double value) const noexcept { return interpolated(values, codes, value); }

std::string unfit(const AxisTable& table) {
  if (table.codes.size() != table.values.size() || table.codes.size() < 2) return "at least two rows";
  const bool rising = table.values[1] > table.values[0];
  for (std::size_t i = 0; i < table.codes.size(); ++i) {
    if (!(table.codes[i] >= 0 && table.codes[i] <= kBoxTopCode)) return "codes from 0 to 4095";
    if (!std::isfinite(table.values[i])) return "finite values";
    if (i == 0) continue;
    if (!(table.codes[i] - table.codes[i - 1] >= kLeastCodes)) return "codes that rise by 1 or more from row to row";
    const double step = table.values[i] - table.values[i - 1];
    if (!((rising ? step : -step) >= kLeastStep)) return "values that rise all the way, or fall all the way";
  }
  return {};
}

BoxWiring::BoxWiring() {
  pedals.fill(-1);
  for (auto& hand : buttons) hand.fill(-1);
}

bool BoxWiring::has(BoxActor actor) const {
  for (const WiredAxis& a : axes[std::size_t(actor)])
    if (a.channel >= 0) return true;
  return false;
}

ChannelMask BoxWiring::mask() const {
  ChannelMask mask = 0;
  for (const auto& actor : axes)
    for (const WiredAxis& a : actor)
      if (a.channel >= 0) mask |= ChannelMask(1) << a.channel;
  return mask;
}

const BoxWiring& default_wiring() {
  static const BoxWiring wiring = [] {
    BoxWiring w;
    const std::vector<double> codes = {409, 3686};
    for (int actor = 0; actor < kBoxActors; ++actor) {
      const bool scope = BoxActor(actor) == BoxActor::scope;
      const double reach = scope ? kScopeReach : kPi / 3;
      const std::array<std::vector<double>, kBoxAxes> spans = {
          {{-reach, reach},
           {-reach, reach},
           {-kPi, kPi},
           {0, 0.3},
           scope ? std::vector<double>{-kPi, kPi} : std::vector<double>{0, 1}}};
      for (int axis = 0; axis < kBoxAxes; ++axis)
        w.axes[std::size_t(actor)][std::size_t(axis)] = {kBoxAxes * actor + axis, {codes, spans[std::size_t(axis)]}};
    }
    for (int pedal = 0; pedal < kBoxPedals; ++pedal) w.pedals[std::size_t(pedal)] = pedal;
    for (int hand = 0; hand < kBoxHands; ++hand)
      for (int button = 0; button < kBoxButtons; ++button)
        w.buttons[std::size_t(hand)][std::size_t(button)] = 8 + kBoxButtons * hand + button;
    return w;
  }();
  return wiring;
}

}  // namespace trocar::devices
