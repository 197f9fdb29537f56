#include "trainer/generator.hpp"

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>

namespace trocar::app {
namespace {

const char* name_of(tissue::EnergyMode mode) {
  switch (mode) {
    case tissue::EnergyMode::cut:
      return "cut";
    case tissue::EnergyMode::blend:
      return "blend";
    case tissue::EnergyMode::coag:
      return "coagulation";
    case tissue::EnergyMode::bipolar:
      return "bipolar";
    case tissue::EnergyMode::off:
      break;
  }
  return "off";
}

constexpr double kSticks = 0.2;  // of ElectrodeState::stuck: worth a warning

GeneratorLine line_of(const std::string& name, const tissue::ElectrodeState& e) {
  const tissue::DischargeFigures& now = e.now;
  GeneratorLine line;
  line.on = now.flows != 0;
  line.warning = now.hot_touch != 0 || e.stuck > kSticks;
  line.text = name + ": " + name_of(now.mode);
  if (line.on) line.text += fmt::format(", {:.0f} W, {:.0f} Ohm", now.output, now.impedance);
  if (!line.on && now.mode != tissue::EnergyMode::off) line.text += ", open circuit";
  if (now.hot_touch) line.text += fmt::format(", hot tip touches: {:.0f} C", e.tip);
  if (e.stuck > kSticks) line.text += ", sticks";
  return line;
}

}  // namespace

std::vector<GeneratorLine> generator_lines(const sim::Model& model, const sim::State& state) {
  std::vector<GeneratorLine> lines;
  if (!model.energy.there) return lines;
  const tissue::GeneratorPanel& p = state.panel;
  lines.push_back({fmt::format("yellow {} {:.0f} W, blue {:.0f} W, bipolar {:.0f} W", name_of(p.yellow), p.yellow_watts,
                               p.blue_watts, p.bipolar_watts)});
  for (size_t t = 0; t < state.electrodes.size() && t < model.hands.size(); ++t)
    if (model.tool(state, t).electrode.there)
      lines.push_back(line_of(attempt::in_words(model.tool(state, t).name), state.electrodes[t].current));
  return lines;
}

}  // namespace trocar::app
