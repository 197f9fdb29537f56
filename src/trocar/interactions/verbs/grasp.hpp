// Grasping: jaws that close on tissue hold the points between them; a pull beyond what friction bears slips.
#pragma once

#include <span>

#include <trocar/interactions/contact/surface.hpp>
#include <trocar/interactions/couplings/loads.hpp>
#include <trocar/interactions/couplings/strand_body.hpp>
#include <trocar/interactions/instrument/membrane_contact.hpp>
#include <trocar/interactions/instrument/tool.hpp>

namespace trocar::interactions {

/// Tissue as the hands meet it: all strands and all organ surfaces, as they are now.
struct TissueView {
  std::span<const StrandBody> strands;
  std::span<const tissue::StrandState> strand_states;
  std::span<const Surface> solids;
  std::span<const SheetView> membranes = {};
};

/// Opens, keeps or ends the grip, and sets how far the jaws close: tissue between them keeps them apart. A grip that
/// ends without the hand's opening has slipped: ToolState::slipped counts those.
void update_grip(const ToolModel& model, const ToolShape& shape, const TissueView& view, ToolState& tool) noexcept;

/// Pulls the held points towards their places between the jaws.
void hold_loads(const ToolShape& shape, int tool_index, const TissueView& view, const ToolState& tool,
                std::span<StrandLoads> strand_loads, std::span<NetworkLoads> organ_loads,
                std::span<NetworkLoads> membrane_loads = {}) noexcept;

/// After the tissue has moved: forces at the jaws, and slip where the pull exceeds friction x pinch.
/// hold[].force holds the forces on the tissue.
void slip(const ToolModel& model, const ToolShape& shape, const TissueView& view, ToolState& tool) noexcept;

/// Where a held point is now.
Vec3d held_point(const TissueView& view, const Hold& hold) noexcept;

}  // namespace trocar::interactions
