// All bodies at once: what a scene is made of, as it is now, and where a tick's loads go. The one bundle that is handed
// to whatever has to do with more than one of them.
#pragma once

#include <trocar/core/body_id.hpp>
#include <trocar/interactions/bodies/models.hpp>
#include <trocar/interactions/bodies/states.hpp>
#include <trocar/interactions/bodies/work.hpp>

namespace trocar::interactions {

struct ObjectModels;
struct ObjectStates;
struct ObjectWork;

/// Objects bring everything with them (objects/object_kinds.hpp).
struct Objects {
  const ObjectModels* models = nullptr;
  const ObjectStates* states = nullptr;
  ObjectWork* work = nullptr;
};

/// Views: valid until the bodies' next tick.
struct Bodies {
  const BodyModels& models;
  const BodyStates& states;
  BodyWork* work = nullptr;  ///< null outside of a tick: skins are not posed then, and nothing takes loads
  Objects objects{};

  std::size_t organ_count() const noexcept { return models.solids.size() + models.cuttables.size(); }
  std::size_t membrane_count() const noexcept { return models.membranes.size(); }
  std::size_t strand_count() const noexcept { return models.strand_bodies.size(); }

  /// In a tick: as posed, nodes as they move.
  const Surface& organ(std::size_t i) const noexcept { return work->surfaces[i]; }
  const SheetView& membrane(std::size_t i) const noexcept { return work->membranes[i].sheet; }
  const StrandBody& strand(std::size_t i) const noexcept { return models.strand_bodies[i]; }
  const tissue::StrandState& strand_state(std::size_t i) const noexcept { return states.strands[i]; }
};

/// Nodes of an organ, a membrane or fat.
tissue::NodeView nodes_of(const Bodies& bodies, BodyId body) noexcept;
tissue::NodeView organ_nodes(const Bodies& bodies, std::size_t organ) noexcept;
tissue::NodeView membrane_nodes(const Bodies& bodies, std::size_t membrane) noexcept;
std::size_t node_count(const Bodies& bodies, BodyId body) noexcept;
/// Where its nodes were drawn, without those that cuts have made [m].
std::span<const Vec3d> drawn_nodes(const BodyModels& models, BodyId body) noexcept;
/// Of a quasi-static organ only the nodes that its solver keeps do.
bool takes_loads(const Bodies& bodies, BodyId body, std::int32_t node) noexcept;
bool is_tetrahedral(const Bodies& bodies, BodyId body) noexcept;
/// Of a tetrahedral body, as cuts have left them.
const geometry::CuttableTets& tets_of(const Bodies& bodies, BodyId body) noexcept;
/// That one; null for bodies of another kind.
const geometry::Tet* cell_of(const Bodies& bodies, BodyId body, std::int32_t cell) noexcept;
/// Of an organ: in a tick with what cuts have made of it.
const tissue::Skin& skin_of(const Bodies& bodies, std::size_t organ) noexcept;
/// Where loads on an organ, a membrane or fat go. Only in a tick.
NetworkLoads& loads_on(const Bodies& bodies, BodyId body) noexcept;

}  // namespace trocar::interactions
