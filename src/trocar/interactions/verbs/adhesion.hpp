// Char glues tissue to an electrode: a point of the tissue is held as between jaws, and torn off by a pull that the
// electrode's figures say (tissue/heat/electrosurgery.hpp).
#pragma once

#include <trocar/interactions/verbs/held.hpp>

namespace trocar::interactions {

/// The point stays where it is beside the instrument.
Hold stuck_at(const ToolShape& shape, const Bodies& bodies, const MaterialPoint& point) noexcept;

/// How hard it is pulled at [N].
double stuck_pull(const ToolShape& shape, const Bodies& bodies, const Hold& stuck) noexcept;

/// Pulls the point towards its place beside the instrument; what that takes is felt as contact.
void stuck_load(const ToolShape& shape, int tool_index, const Bodies& bodies, const Hold& stuck) noexcept;

}  // namespace trocar::interactions
