// A strand's end that grows out of an organ: the end follows a patch of the organ's nodes exactly, and the patch takes
// the strand's pull, implicitly, so that a light patch under a stiff strand stays stable.
#pragma once

#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>

namespace trocar::interactions {

/// Const after compile. Weights sum to 1 and reproduce the drawn end's position for every affine motion of the organ.
struct HostPatch {
  std::vector<std::int32_t> node;
  std::vector<float> weight;
  Vec3d offset{0, 0, 0};      ///< drawn end minus the patch's weighted mean (zero but for rounding) [m]
  Vec3d drawn_pull{0, 0, 0};  ///< of the strand in the drawn shape: the organ is drawn bearing it already [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("weight", s.weight), v("offset", s.offset), v("drawn_pull", s.drawn_pull);
  }
};

/// Smooth weights around `point` over the nodes within `radius`, corrected to be affine-exact.
/// @param rest, mass  (nodes) of the organ in the drawn shape [m], [kg]
/// Throws std::invalid_argument when fewer than four nodes are there.
HostPatch make_patch(std::span<const Vec3d> rest, std::span<const double> mass, Vec3d point, double radius);

/// Where the strand's end is when this tick ends.
tissue::StrandEnd hosted_end(const HostPatch& patch, const tissue::NodeView& nodes, double dt) noexcept;

/// Gives the strand's pull to the patch.
void host_loads(const HostPatch& patch, const tissue::StrandReaction& reaction, const tissue::NodeView& nodes,
                double dt, int strand, NetworkLoads& loads) noexcept;

}  // namespace trocar::interactions
