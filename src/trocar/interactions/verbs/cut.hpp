// Scissors close: every strand between the blades is cut as far as the blades reach over it. A whole cut separates the
// strand (network and surface); a part of it weakens what is left.
#pragma once

#include <optional>
#include <span>

#include <trocar/interactions/verbs/between_blades.hpp>
#include <trocar/interactions/verbs/grasp.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

namespace trocar::interactions {

struct CutBook {
  std::span<Cut> cuts;  ///< kMaxCuts
  std::int32_t& count;
  bool* refused = nullptr;  ///< becomes true where a strand was not cut because there was no room for its record
};

/// A cross-section counts as cut through from this fraction on.
inline constexpr double kThrough = 0.99;

/// @return number of strands cut this tick
int update_scissors(const ToolModel& model, const ToolShape& shape, int tool_index, const Bodies& bodies,
                    std::span<tissue::StrandState> strand_states, int tips_visible, std::uint64_t tick, ToolState& tool,
                    CutBook book) noexcept;

/// Parts an organ along a blade: springs that cross it are severed, and triangles of the drawn skin that cross it are
/// marked in `parted` (one byte a triangle). For organs that are not meant to be cut (those are
/// tissue/tets/cuttable.hpp): nothing is snapped or refined. What would be cut loose stays on a thread of one spring,
/// so that nothing falls out of the world.
/// @param scratch  at least as many numbers as the network has nodes; contents of no use
/// @return springs severed
int cut_organ(const geometry::Blade& blade, const tissue::NetworkModel& network, const tissue::Skin& fine,
              tissue::NetworkState& state, std::span<std::uint8_t> parted, std::span<std::int32_t> scratch) noexcept;

/// What closing blades are about to sweep in flesh: a flat strip from the hinge to their tips, as wide as they were
/// open. It comes once for every closing (ToolState::armed is below 0 then, until they open again), and before they
/// meet: what lies between edges does not slip out ahead of them, as it would ahead of blunt rods.
std::optional<geometry::Blade> sweep_of_blades(const ToolModel& model, const ToolShape& shape,
                                               ToolState& tool) noexcept;

/// What one closing of the blades did to a fold.
struct FoldCut {
  int severed = 0;   ///< springs
  double depth = 0;  ///< how deep the blades went into it [m]
};
/// Parts a membrane along a blade, as cut_organ() does an organ. What still hangs on a border may be cut from the
/// other; what would hang on none stays on a thread.
/// @param depth   (nodes) way from the surface of the strand on its border, in the drawn shape [m]
/// @param parted  (triangles of the sheet)
FoldCut cut_membrane(const geometry::Blade& blade, const tissue::MembraneModel& sheet, std::span<const float> depth,
                     tissue::MembraneState& state, std::span<std::uint8_t> parted,
                     std::span<std::int32_t> scratch) noexcept;

}  // namespace trocar::interactions
