#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>
#include <trocar/interactions/instrument/lever.hpp>

namespace trocar::attempt {

constexpr double kFogTold = 0.15;  // fog below it hardly shows (our choice)

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

int hand_count(const sim::Model& model) { return int(model.hands.size()); }

std::string hand_name(const sim::Model& model, int h) { return in_words(model.hands[size_t(h)].name); }

std::array<int, 2> sides_of(const sim::Model& model) {
  if (model.hands.size() < 2) return {0, 1};
  Vec3d ahead;
  for (std::size_t h = 0; h < model.hands.size(); ++h)
    ahead += kinematics::forward(model.hands[h].port, pose_of(model.start.tools[h])).tip - model.scope.port;
  const Vec3d right = cross(model.gravity, ahead);
  if (dot(model.hands[1].port - model.hands[0].port, right) < 0) return {1, 0};
  return {0, 1};
}

const interactions::ToolModel& held_by(const sim::Model& model, const sim::State& state, int h) {
  return model.tool(state, size_t(h));
}

bool has_valves(const sim::Model& model, const sim::State& state, int h) {
  return held_by(model, state, h).can().irrigate || held_by(model, state, h).can().inject;
}

bool is_bare_electrode(const sim::Model& model, const sim::State& state, int h) {
  const interactions::Abilities& can = held_by(model, state, h).can();
  return can.coagulate && !can.grip;
}

std::string flow_in_words(const sim::State& state, int h) {
  const std::uint8_t valves = state.valves[size_t(h)];
  std::string out = (valves & sim::kIrrigates) != 0 ? "water" : "";
  if ((valves & sim::kSucks) == 0) return out;
  if (!out.empty()) out += ", ";
  return out + ((valves & sim::kPlugged) != 0    ? "suction: plugged by tissue"
                : (valves & sim::kSucksGas) != 0 ? "suction: gas"
                                                 : "suction");
}

std::vector<std::string> fluid_account(const sim::Model& model, const sim::State& state) {
  if (!model.wet.there) return {};
  const fluids::Ledger& ledger = state.fluids.ledger;
  const auto line = [](const char* what, const fluids::Mix& mix) {
    return fmt::format("{} {:.1f} mL", what, double(mix.total()) / double(fluids::kMillilitre));
  };
  const fluids::Mix on_tissue = at(ledger, fluids::Place::kDroplets) + at(ledger, fluids::Place::kFilm);
  std::vector<std::string> out{line("bled", ledger.in[size_t(fluids::Source::kBled)]),
                               line("irrigated", ledger.in[size_t(fluids::Source::kIrrigated)]),
                               line("in the pool", at(ledger, fluids::Place::kPool)),
                               line("sucked away", at(ledger, fluids::Place::kSucked)),
                               line("drops and film", on_tissue)};
  if (!at(ledger, fluids::Place::kDrained).empty()) out.push_back(line("drained", at(ledger, fluids::Place::kDrained)));
  return out;
}

std::vector<std::string> patient_in_words(const sim::Model& model, const sim::State& state) {
  if (!model.vessels.there()) return {};
  const vessels::Vitals v = vessels::vitals(model.vessels.flow, state.flow);
  std::vector<std::string> out{tr("pulse {:.0f}/min, {:.0f}/{:.0f} mmHg", v.rate, v.systolic / vessels::kPascalPerMmHg,
                                  v.diastolic / vessels::kPascalPerMmHg)};
  if (model.wet.there) {
    const double gas = state.fluids.gas.pressure;
    const bool low = gas < 0.8 * model.wet.model.insufflator.set;
    out.push_back(tr("gas in the abdomen {:.0f} mmHg{}", gas / vessels::kPascalPerMmHg, low ? ", low" : ""));
  }
  double gain = 1;
  for (const sim::Vessel& vessel : model.vessels.list)
    if (std::fabs(vessel.gain - 1) > std::fabs(gain - 1)) gain = vessel.gain;
  if (gain != 1) out.push_back(tr("arteries' pulse shown and felt {:g} times", gain));
  return out;
}

std::string lens_in_words(const sim::Model& model, const sim::State& state) {
  const fluids::SmokeState& lens = state.fluids.smoke;
  if (!model.wet.there) return {};
  if (lens.wipe_left > 0) return tr("lens is being wiped, {:.0f} s", std::ceil(lens.wipe_left));
  return lens.fog < kFogTold ? std::string() : tr("lens fogged, {:.0f} %", 100 * lens.fog);
}

std::vector<Choosable> choosable(const sim::Model& model, const sim::State& state, int h) {
  std::vector<Choosable> out;
  const std::vector<interactions::ToolModel>& rack = model.hands[size_t(h)].rack;
  for (std::size_t i = 0; i < rack.size(); ++i)
    out.push_back({int(i), in_words(rack[i].name), int(i) == state.tools[size_t(h)].instrument});
  return out;
}

double pull_on(const sim::State& state, int h) {
  const double(&f)[3] = state.tools[size_t(h)].pull;
  return length(Vec3d{f[0], f[1], f[2]});
}

double push_at_trocar(const sim::Model& model, const sim::State& state, int h) {
  const size_t hand = size_t(h);
  return length(interactions::load_at_trocar(model.tool(state, hand), state.tools[hand], state.touches[hand]).on_wall);
}

}  // namespace trocar::attempt
