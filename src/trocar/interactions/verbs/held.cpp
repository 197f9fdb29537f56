#include <trocar/interactions/verbs/held.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFoldThickness = 0.0025;  // [m] a pinched fold of an organ's surface
constexpr double kCompressed = 0.7;        // thickness of a strand between jaws that just hold it, of its diameter

/// f(kind, its models, its states) where the body is an object that is no tissue and that jaws hold.
template <class F>
bool on_object_kind(const Bodies& bodies, BodyId body, F&& f) noexcept {
  bool found = false;
  visit_object(body, [&](auto kind) {
    using K = decltype(kind);
    if constexpr (!K::kIsTissue && requires { &K::pull; })
      f(kind, models_of<K>(bodies), states_of<K>(bodies)), found = true;
  });
  return found;
}

}  // namespace

Vec3d held_point(const Bodies& bodies, const MaterialPoint& p) noexcept {
  Vec3d at;
  if (on_object_kind(bodies, p.body,
                     [&](auto kind, auto& models, auto& states) { at = kind.point(models, states, p); }))
    return at;
  return place_of(bodies, p);
}

Vec3d drawn_point(const Bodies& bodies, const MaterialPoint& p) noexcept {
  if (p.body.is(BodyKind::strand)) return {arc_of(bodies.models, p), 0, 0};
  const bool heats = p.body.is(BodyKind::organ) || p.body.is(BodyKind::membrane);
  return heats ? drawn_place(bodies, p) : Vec3d{};  // current does nothing to the others
}

bool is_whole(const Bodies& bodies, const MaterialPoint& p) noexcept {
  const std::size_t i = p.body.index();
  if (p.body.is(BodyKind::strand)) return bodies.strand_state(i).alive[std::size_t(p.element)] != 0;
  if (p.body.is(BodyKind::fat)) return !bodies.states.fat[i].lobules[std::size_t(p.node[0])].gone();
  return !p.body.is(BodyKind::organ) || !bodies.organ(i).torn(vertex_of(bodies, p));
}

double held_thickness(const Bodies& bodies, const MaterialPoint& p) noexcept {
  const std::size_t i = p.body.index();
  if (p.body.is(BodyKind::strand)) return 2 * kCompressed * bodies.strand(i).model.radius[std::size_t(p.element)];
  if (p.body.is(BodyKind::organ)) return kFoldThickness;
  if (p.body.is(BodyKind::membrane))
    return (bodies.membrane(i).pinch_reach > 0 ? 4 : 2) * bodies.membrane(i).half_thickness;
  if (p.body.is(BodyKind::fat)) return Fat::thickness(bodies.models.fat[i]);
  double thick = 0;
  on_object_kind(bodies, p.body, [&](auto kind, auto& models, auto&) { thick = kind.thickness(models, p); });
  return thick;
}

double held_reach(const Bodies& bodies, BodyId body) noexcept {
  return body.is(BodyKind::membrane) ? bodies.membrane(body.index()).pinch_reach : 0;
}

void pull_to(const Bodies& bodies, const MaterialPoint& p, Vec3d target, HoldLaw law, Tag tag) noexcept {
  const bool done = on_object_kind(bodies, p.body, [&](auto kind, auto& models, auto& states) {
    kind.pull(models, states, p, target, law, tag, work_of<decltype(kind)>(bodies));
  });
  if (!done) put_load(bodies, p, {.k = law.stiffness, .target = target, .d = law.damping}, tag);
}

}  // namespace trocar::interactions
