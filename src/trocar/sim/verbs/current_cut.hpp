// A continuous wave parts tissue: where the cells at the wire have burst, organs and folds are cut along the way that
// it goes, as by a small blade; a strand is cut through once it has burst across.
#pragma once

#include <array>

#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Places of a strand's section that stand for all of it, in its frame of heat: the middle, four around it.
struct Section {
  double reach = 0;  ///< from the middle to those around it [m]
  Vec3d middle;
  std::array<Vec3d, 4> around;
};
/// @param s  arc length [m], within that element
Section section_of(const StepContext& context, BodyId strand, int element, double s) noexcept;

/// Has the tissue burst there? In the body's frame of heat [m].
bool has_burst(const StepContext& context, BodyId body, Vec3d at) noexcept;

/// Once in a step of the heat, for a hand whose electrode gives a continuous wave to the tissue at `touch`.
void part_tissue(StepContext& context, size_t hand, const interactions::ElectrodeTouch& touch) noexcept;

}  // namespace trocar::sim
