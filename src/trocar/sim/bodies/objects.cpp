#include <trocar/interactions/objects/rigid_on_skin.hpp>
#include <trocar/sim/bodies/objects.hpp>

namespace trocar::sim {
namespace {

/// f(kind, models, states, work) of every kind of object.
template <class F>
void for_kinds(StepContext& c, F&& f) noexcept {
  interactions::ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    f(kind, interactions::part_of<K>(c.model), interactions::part_of<K>(c.state), interactions::part_of<K>(c.work));
  });
}

}  // namespace

void hang_objects(StepContext& c) noexcept {
  for_kinds(c, [](auto kind, const auto&, auto&, auto& work) { kind.clear(work); });
}

void touch_objects(StepContext& c, const HandContact& hand) noexcept {
  const interactions::ObjectHand at{hand.tool, c.state.tools[hand.hand], hand.touching};
  for_kinds(c,
            [&at](auto kind, const auto& models, auto& states, auto& work) { kind.touch(models, states, at, work); });
}

void rest_objects(StepContext& c) noexcept {
  using interactions::Rigid;
  const interactions::RigidModels& models = interactions::part_of<Rigid>(c.model);
  if (models.list.empty()) return;
  const Rigid::States& states = interactions::part_of<Rigid>(c.state);
  interactions::RigidWork& work = interactions::part_of<Rigid>(c.work);
  for (size_t i = 0; i < size_t(c.model.organs()); ++i)
    rest_on_skin(models, states, c.work.surfaces[i], c.work.organs[i].loads, work);
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    if (c.model.membranes[i].sheet.closed())
      rest_on_skin(models, states, c.work.membranes[i].sheet.surface, c.work.membranes[i].loads, work);
}

void advance_objects(StepContext& c) noexcept {
  for_kinds(c, [&c](auto kind, const auto& models, auto& states, auto& work) {
    const tissue::StepReport r = kind.advance(models, c.model.gravity, kTick, c.model.cavity, states, work);
    c.report.flags |= r.flags | (kind.overloaded(work) ? StepReport::kTooManyLoads : 0u);
    if (r.fine() || c.report.first_bad_body.exists()) return;
    c.report.first_bad_body = BodyId(kind.kKind, size_t(r.first_bad));
    c.report.first_bad_index = 0;
  });
}

}  // namespace trocar::sim
