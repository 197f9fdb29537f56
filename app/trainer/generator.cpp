#include "trainer/generator.hpp"

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

const char* name_of(tissue::EnergyMode mode) {
  switch (mode) {
    case tissue::EnergyMode::cut:
      return tr("cut");
    case tissue::EnergyMode::blend:
      return tr("blend");
    case tissue::EnergyMode::coag:
      return tr("coagulation");
    case tissue::EnergyMode::bipolar:
      return tr("bipolar");
    case tissue::EnergyMode::off:
      break;
  }
  return tr("off");
}

constexpr double kSticks = 0.2;  // of ElectrodeState::stuck: worth a warning

std::string current_text(const std::string& name, const tissue::DischargeFigures& now) {
  if (now.flows != 0) return tr("{}: {}, {:.0f} W into {:.0f} Ohm", name, name_of(now.mode), now.output, now.impedance);
  if (now.mode != tissue::EnergyMode::off) return tr("{}: {}, open circuit", name, name_of(now.mode));
  return tr("{}: off", name);
}

GeneratorLine line_of(const std::string& name, const tissue::ElectrodeState& e) {
  const tissue::DischargeFigures& now = e.now;
  GeneratorLine line;
  line.on = now.flows != 0;
  line.warning = now.hot_touch != 0 || e.stuck > kSticks;
  line.text = now.hot_touch != 0  ? tr("{}: the hot tip touches tissue, {:.0f} °C", name, e.tip)
              : e.stuck > kSticks ? tr("{}: the tip sticks to tissue", name)
                                  : current_text(name, now);
  return line;
}

}  // namespace

std::vector<GeneratorLine> generator_lines(const sim::Model& model, const sim::State& state) {
  std::vector<GeneratorLine> lines;
  if (!model.energy.there) return lines;
  const tissue::GeneratorPanel& p = state.panel;
  lines.push_back({tr("Pedals: yellow {} {:.0f} W, blue {:.0f} W, bipolar {:.0f} W", name_of(p.yellow), p.yellow_watts,
                      p.blue_watts, p.bipolar_watts)});
  for (size_t t = 0; t < state.electrodes.size() && t < model.hands.size(); ++t)
    if (model.tool(state, t).electrode.there)
      lines.push_back(line_of(attempt::in_words(model.tool(state, t).name), state.electrodes[t].current));
  return lines;
}

}  // namespace trocar::app
