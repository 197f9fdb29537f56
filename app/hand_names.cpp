#include "hand_names.hpp"

#include <algorithm>

#include <trocar/interactions/lever.hpp>

namespace trocar::app {

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

int hand_count(const sim::Model& model) { return int(model.hands.size()); }

std::string hand_name(const sim::Model& model, int h) { return in_words(model.hands[size_t(h)].name); }

const interactions::ToolModel& held_by(const sim::Model& model, const sim::State& state, int h) {
  return model.tool(state, size_t(h));
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

}  // namespace trocar::app
