#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {
namespace {

int places(const Model& m, SolidRef r) { return m.solids[r.index].skin.size(); }
int places(const Model& m, CuttableRef r) { return m.cuttables[r.index].skin.skin.size(); }
int places(const Model& m, StrandRef r) { return m.strand_bodies[r.index].nodes() - 1; }
int places(const Model& m, MembraneRef r) { return m.membranes[r.index].sheet.nodes(); }

}  // namespace

bool has(const Model& model, BodyId body) noexcept {
  bool found = false;
  visit_bodies(model, [&](auto ref) { found = found || ref.id() == body; });
  interactions::visit_objects(model, [&](auto, BodyId id) { found = found || id == body; });
  return found;
}

const std::string& name_of(const Model& model, BodyId body) {
  static const std::string nothing = "nothing", wall = "a wall";
  const std::string* name = body.is(BodyKind::wall) ? &wall : &nothing;
  visit(model, body, [&](auto ref) { name = &model_of(model, ref).name; });
  interactions::visit_object(
      body, [&](auto kind) { name = &kind.name(interactions::part_of<decltype(kind)>(model), body.index()); });
  return *name;
}

BodyId body_of(const Model& model, const std::string& name) {
  BodyId found;
  visit_bodies(model, [&](auto ref) {
    if (!found.exists() && model_of(model, ref).name == name) found = ref.id();
  });
  interactions::visit_objects(model, [&](auto kind, BodyId id) {
    if (!found.exists() && kind.name(interactions::part_of<decltype(kind)>(model), id.index()) == name) found = id;
  });
  return found;
}

std::int32_t lattice_of(const Model& model, int organ) noexcept {
  return organ < int(model.solids.size()) ? organ : -1;
}

const CuttableOrgan& cuttable_of(const Model& model, int organ) noexcept {
  return model.cuttables[size_t(organ) - model.solids.size()];
}

std::span<const Vec3d> drawn_nodes(const Model& model, int organ) noexcept {
  return interactions::drawn_nodes(model, BodyId::organ(size_t(organ)));
}

int places_on(const Model& model, BodyId body) {
  if (!has(model, body)) return 0;
  int count = visit(model, body, 0, [&](auto ref) { return places(model, ref); });
  interactions::visit_object(body, [&](auto kind) {
    count = kind.grip_point_count(interactions::part_of<decltype(kind)>(model), body.index());
  });
  return count;
}

const std::string& Model::organ_name(int organ) const {
  return visit_organ(*this, size_t(organ),
                     [this](auto ref) -> const std::string& { return model_of(*this, ref).name; });
}
const std::string& Model::organ_look(int organ) const {
  return visit_organ(*this, size_t(organ),
                     [this](auto ref) -> const std::string& { return model_of(*this, ref).look; });
}
tissue::NodeView nodes_of(const Model& model, const State& s, int organ) noexcept {
  return organ_nodes(bodies_of(model, s), size_t(organ));
}

}  // namespace trocar::sim
