// Bodies as heat sees them: which cells of a body's frame are tissue. Bodies have the numbers that holds give them
// (core/body_id.hpp), frames are those of interactions/verbs/electrode_contact.hpp.
//   organs   what lies within the drawn skin, uncut: cells that a cut has bared are still tissue to heat
//   folds    what lies within half their thickness of their triangles in the drawn shape, at least 0.87 of a cell, so
//            that cells are connected by their faces: folds thinner than 1.7 cells are computed that thick
//   strands  what lies within their radius; a lumen is a gap that lies shut
#pragma once

#include <trocar/sim/model/model.hpp>

namespace trocar::sim {

/// Fills Model::energy's masks, which are kept so that asking about a brick allocates nothing. For compile: all bodies
/// and Model::energy.heat must be there.
void note_heat_bodies(Model& model);

/// @param model  must outlive it
tissue::TissueShape tissue_shape(const Model& model) noexcept;

}  // namespace trocar::sim
