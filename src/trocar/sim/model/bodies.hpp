// All bodies of a Model by kind: the one place that knows which kinds there are and how they are numbered. Functions of
// a kind take its reference and are overloads of one name (sim/bodies, a file a kind), so that code that handles a
// body names the operation and not the kind:
//
//   visit_bodies(model, [&](auto body) { hang(context, body); });            // each in turn
//   visit(model, hold.body, [&](auto body) { advance(context, body); });     // that one; nothing where there is none
//   visit(model, id, 0.0, [&](auto body) { return mass_of(model, body); });  // ... or 0
//
// An organ is a lattice or of tetrahedra (it can be cut then); code for holds, contacts and vessels need not know.
// Their numbers: lattices first.
#pragma once

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Functions for kinds, as one: Overloaded{[](SolidRef) { ... }, [](auto) { ... }}.
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// A lattice.
struct SolidRef {
  std::size_t index = 0;  ///< in Model::solids
  std::size_t organ() const noexcept { return index; }
  BodyId id() const noexcept { return BodyId::organ(organ()); }
};
/// An organ of tetrahedra.
struct CuttableRef {
  std::size_t index = 0;  ///< in Model::cuttables
  std::size_t number = 0;
  std::size_t organ() const noexcept { return number; }
  BodyId id() const noexcept { return BodyId::organ(organ()); }
};
struct StrandRef {
  std::size_t index = 0;
  BodyId id() const noexcept { return BodyId::strand(index); }
};
struct MembraneRef {
  std::size_t index = 0;
  BodyId id() const noexcept { return BodyId::membrane(index); }
};

inline const SolidModel& model_of(const Model& m, SolidRef r) noexcept { return m.solids[r.index]; }
inline const CuttableOrgan& model_of(const Model& m, CuttableRef r) noexcept { return m.cuttables[r.index]; }
inline const StrandAnatomy& model_of(const Model& m, StrandRef r) noexcept { return m.strands[r.index]; }
inline const MembraneBody& model_of(const Model& m, MembraneRef r) noexcept { return m.membranes[r.index]; }
inline const interactions::StrandBody& rod_of(const Model& m, StrandRef r) noexcept { return m.strand_bodies[r.index]; }

/// What of the State is that body's, const or not.
auto& state_of(auto& s, SolidRef r) noexcept { return s.solids[r.index]; }
auto& state_of(auto& s, CuttableRef r) noexcept { return s.cuttables[r.index]; }
auto& state_of(auto& s, StrandRef r) noexcept { return s.strands[r.index]; }
auto& state_of(auto& s, MembraneRef r) noexcept { return s.membranes[r.index]; }

/// Of bodies that are a network: its model and its state.
inline const tissue::NetworkModel& network_of(const Model& m, SolidRef r) noexcept { return model_of(m, r).network; }
inline const tissue::NetworkModel& network_of(const Model& m, MembraneRef r) noexcept {
  return model_of(m, r).sheet.network;
}
auto& network_state_of(auto& s, SolidRef r) noexcept { return state_of(s, r); }
auto& network_state_of(auto& s, MembraneRef r) noexcept { return state_of(s, r).network; }

/// f(SolidRef) or f(CuttableRef) of the organ with that number.
template <class F>
decltype(auto) visit_organ(const Model& model, std::size_t organ, F&& f) {
  const std::size_t lattices = model.solids.size();
  if (organ < lattices) return f(SolidRef{organ});
  return f(CuttableRef{organ - lattices, organ});
}
template <class F>
void visit_solids(const Model& model, F&& f) {
  for (std::size_t i = 0; i < model.solids.size(); ++i) f(SolidRef{i});
}
template <class F>
void visit_cuttables(const Model& model, F&& f) {
  for (std::size_t i = 0; i < model.cuttables.size(); ++i) f(CuttableRef{i, model.solids.size() + i});
}
template <class F>
void visit_organs(const Model& model, F&& f) {
  visit_solids(model, f);
  visit_cuttables(model, f);
}
template <class F>
void visit_membranes(const Model& model, F&& f) {
  for (std::size_t i = 0; i < model.membranes.size(); ++i) f(MembraneRef{i});
}
template <class F>
void visit_strands(const Model& model, F&& f) {
  for (std::size_t i = 0; i < model.strands.size(); ++i) f(StrandRef{i});
}
/// Organs, strands, membranes: all that is tissue.
template <class F>
void visit_bodies(const Model& model, F&& f) {
  visit_organs(model, f);
  visit_strands(model, f);
  visit_membranes(model, f);
}

/// Of bodies of tissue: objects have visit_object() (interactions/objects/object_kinds.hpp).
/// @return f of that body; `otherwise` where it is none
template <class Result, class F>
Result visit(const Model& model, BodyId body, Result otherwise, F&& f) {
  switch (body.kind()) {
    case BodyKind::strand:
      return f(StrandRef{body.index()});
    case BodyKind::organ:
      return visit_organ(model, body.index(), f);
    case BodyKind::membrane:
      return f(MembraneRef{body.index()});
    default:
      break;
  }
  return otherwise;
}
template <class F>
void visit(const Model& model, BodyId body, F&& f) {
  visit(model, body, false, [&f](auto ref) { return f(ref), true; });
}

/// All bodies at once, outside of a tick.
inline interactions::Bodies bodies_of(const Model& model, const State& state) noexcept {
  return {model, state, nullptr, {&model.objects, &state.objects, nullptr}};
}

/// Is it a body of this Model?
bool has(const Model& model, BodyId body) noexcept;
/// Its name in the scene; "nothing" of none, "a wall" of walls.
const std::string& name_of(const Model& model, BodyId body);
/// The body of that name; none if there is none.
BodyId body_of(const Model& model, const std::string& name);
/// Its number as a lattice; -1 where it is none.
std::int32_t lattice_of(const Model& model, int organ) noexcept;
/// @param organ  that is no lattice
const CuttableOrgan& cuttable_of(const Model& model, int organ) noexcept;
/// Where an organ's nodes were drawn, without those that cuts have made [m].
std::span<const Vec3d> drawn_nodes(const Model& model, int organ) noexcept;
/// How many things on it jaws and electrodes can be at: elements of strands, vertices of skins, nodes of membranes.
int places_on(const Model& model, BodyId body);

/// Bodies with a skin that follows their nodes are numbered organs first, then membranes (Work::skin_order).
template <class F>
void visit_skinned(const Model& model, std::size_t number, F&& f) {
  const std::size_t organs = std::size_t(model.organs());
  if (number < organs) return visit_organ(model, number, f);
  f(MembraneRef{number - organs});
}

}  // namespace trocar::sim
