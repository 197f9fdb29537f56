#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {
namespace {

constexpr double kFatConducts = 0.3;  // beside wet tissue: fat is a poor conductor.                Our choice
constexpr double kDryConducts = 0.3;  // of that: what has dried is crossed by sparks.              Our choice

/// f(bond, its state, the lobule) of what lobules hang on.
template <class F>
void for_roots(StepContext& c, size_t body, F&& f) noexcept {
  const size_t set = size_t(c.model.fat[body].roots);
  for (size_t i = 0; i < c.model.bonds[set].bonds.size(); ++i) {
    const interactions::Bond& bond = c.model.bonds[set].bonds[i];
    f(bond, c.state.bonds[set][i], c.state.fat[body].lobules[size_t(bond.node())]);
  }
}

/// What is tied to lobules that are gone hangs free.
void part_from_gone(StepContext& c, BodyId fat) noexcept {
  const auto is_gone = [&](const interactions::MaterialPoint& at) {
    return at.body == fat && c.state.fat[fat.index()].lobules[size_t(at.node[0])].gone();
  };
  for (size_t set = 0; set < c.model.bonds.size(); ++set)
    for (size_t i = 0; i < c.state.bonds[set].size(); ++i) {
      const interactions::Bond& bond = c.model.bonds[set].bonds[i];
      if (is_gone(bond.near) || is_gone(bond.far)) c.state.bonds[set][i] = {1, interactions::BondState::burnt};
    }
}

}  // namespace

// What holds a coagulated lobule parts at a fifth of its opening.
void weaken_coagulated(StepContext& c) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t i = 0; i < c.model.fat.size(); ++i) {
    const interactions::BondSet& set = c.model.bonds[size_t(c.model.fat[i].roots)];
    for_roots(c, i, [&](const interactions::Bond& bond, interactions::BondState& state, const tissue::Lobule& lobule) {
      if (lobule.coagulated() && state.holds())
        weaken(set, length(opening_of(bodies, bond)), 1 / tissue::kCoagulatedStrength, kTick, state);
    });
  }
}

int sever_septa(StepContext& c, const geometry::Blade& blade) noexcept {
  int severed = 0;
  for (size_t i = 0; i < c.model.fat.size(); ++i)
    severed += interactions::sever_septa(c.model.fat[i], blade, c.state.fat[i]);
  return severed;
}

FatTouch fat_at(const StepContext& c, std::size_t hand) noexcept {
  FatTouch best;
  const std::vector<interactions::FatBody>& bodies = c.model.fat;
  const std::vector<tissue::FatState>& states = c.state.fat;
  const interactions::ToolShape& shape = c.work.shapes[hand];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto look = [&](interactions::Capsule wire) {
      const int lobule = interactions::lobule_at(bodies[i], states[i], wire);
      if (lobule < 0) return;
      const Vec3d place = tissue::position(bodies[i].fat, states[i], lobule);
      const double apart = length(place - collision::nearest_on_axis(wire, place)) - wire.radius - bodies[i].fat.radius;
      if (!best.there() || apart < best.apart)
        best = {at_node(bodies_of(c), BodyId(BodyKind::fat, i), lobule), place, apart};
    };
    interactions::Capsule wire = shape.part[interactions::kJawA];
    wire.a = wire.b - interactions::kBareWire * normalised(wire.b - wire.a, shape.frame.axis());
    look(wire);
    look(shape.part[interactions::kJawB]);
  }
  return best;
}

tissue::HeatContact fat_contact(const StepContext& c, const FatTouch& touch) noexcept {
  const std::size_t body = touch.at.body.index();
  const tissue::FatModel& m = c.model.fat[body].fat;
  const tissue::FatState& s = c.state.fat[body];
  const int lobule = touch.at.node[0];
  const double wet = 1 - s.lobules[std::size_t(lobule)].boiled / (m.material.water * m.mass);
  const double celsius = tissue::temperature(m, s, lobule);
  return {m.volume, kFatConducts * (kDryConducts + (1 - kDryConducts) * wet), celsius, celsius};
}

double warm_fat(StepContext& c, const FatTouch& touch, double joules) noexcept {
  tissue::FatState& state = c.state.fat[touch.at.body.index()];
  const std::int32_t gone = state.gone;
  const double boiled = interactions::warm_fat(c.model.fat[touch.at.body.index()], touch.at.node[0], joules, state);
  if (state.gone > gone) part_from_gone(c, touch.at.body);
  return boiled;
}

bool behind_fat(const Model& model, const State& state, Vec3d from, Vec3d to) noexcept {
  return interactions::Fat::hides(model.fat, state.fat, from, to);
}

}  // namespace trocar::sim
