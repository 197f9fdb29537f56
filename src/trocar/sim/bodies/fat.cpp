#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {
namespace {

using interactions::Fat;

constexpr double kFatConducts = 0.3;  // beside wet tissue: fat is a poor conductor.                Our choice
constexpr double kDryConducts = 0.3;  // of that: what has dried is crossed by sparks.              Our choice

/// f(body, state, work) of every body of fat.
template <class F>
void for_fat(StepContext& c, F&& f) noexcept {
  const auto& bodies = interactions::part_of<Fat>(c.model.objects).list;
  if (bodies.empty()) return;
  auto& states = interactions::part_of<Fat>(c.state.objects);
  auto& works = interactions::part_of<Fat>(c.work.objects).list;
  for (std::size_t i = 0; i < bodies.size(); ++i) f(bodies[i], states[i], works[i]);
}

}  // namespace

bool has_fat(const Model& model) noexcept { return !interactions::part_of<Fat>(model.objects).list.empty(); }

void apply_fat_loads(StepContext& c) noexcept {
  if (!has_fat(c.model)) return;
  const interactions::Bodies bodies = bodies_of(c);
  for_fat(c, [&](const interactions::FatBody& body, interactions::FatBodyState& state,
                 interactions::FatBodyWork& work) { interactions::apply_fat_loads(body, state, bodies, kTick, work); });
}

int sever_fat(StepContext& c, const geometry::Blade& blade) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  int severed = 0;
  for_fat(c, [&](const interactions::FatBody& body, interactions::FatBodyState& state, interactions::FatBodyWork&) {
    severed += interactions::sever_fat(body, blade, bodies, state);
  });
  return severed;
}

FatTouch fat_at(const StepContext& c, std::size_t hand) noexcept {
  FatTouch best;
  const auto& bodies = interactions::part_of<Fat>(c.model.objects).list;
  const auto& states = interactions::part_of<Fat>(c.state.objects);
  const interactions::ToolShape& shape = c.work.shapes[hand];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto look = [&](interactions::Capsule wire) {
      const int lobule = interactions::lobule_at(bodies[i], states[i], wire);
      if (lobule < 0) return;
      const Vec3d place = tissue::position(bodies[i].fat, states[i].fat, lobule);
      const double apart = length(place - collision::nearest_on_axis(wire, place)) - wire.radius - bodies[i].fat.radius;
      if (!best.there() || apart < best.apart) best = {int(i), lobule, place, apart};
    };
    interactions::Capsule wire = shape.part[interactions::kJawA];
    wire.a = wire.b - interactions::kBareWire * normalised(wire.b - wire.a, shape.frame.axis());
    look(wire);
    look(shape.part[interactions::kJawB]);
  }
  return best;
}

tissue::HeatContact fat_contact(const StepContext& c, const FatTouch& touch) noexcept {
  const tissue::FatModel& m = interactions::part_of<Fat>(c.model.objects).list[std::size_t(touch.body)].fat;
  const tissue::FatState& s = interactions::part_of<Fat>(c.state.objects)[std::size_t(touch.body)].fat;
  const double wet = 1 - s.lobules[std::size_t(touch.lobule)].boiled / (m.material.water * m.mass);
  const double celsius = tissue::temperature(m, s, touch.lobule);
  return {m.volume, kFatConducts * (kDryConducts + (1 - kDryConducts) * wet), celsius, celsius};
}

double warm_fat(StepContext& c, const FatTouch& touch, double joules) noexcept {
  const auto& bodies = interactions::part_of<Fat>(c.model.objects).list;
  auto& states = interactions::part_of<Fat>(c.state.objects);
  return interactions::warm_fat(bodies[std::size_t(touch.body)], touch.lobule, joules, states[std::size_t(touch.body)]);
}

bool behind_fat(const Model& model, const State& state, Vec3d from, Vec3d to) noexcept {
  return Fat::hides(interactions::part_of<Fat>(model.objects), interactions::part_of<Fat>(state.objects), from, to);
}

}  // namespace trocar::sim
