#include <trocar/interactions/verbs/adhesion.hpp>

namespace trocar::interactions {
namespace {

constexpr double kStiffness = 500;  // [N/m]    Our choice: 2 N tear it off 4 mm away
constexpr double kDamping = 0.5;    // [N s/m]  Our choice

Vec3d target_of(const ToolShape& shape, const Hold& stuck) noexcept {
  return from_jaw(shape, {stuck.local[0], stuck.local[1], stuck.local[2]});
}

}  // namespace

Hold stuck_at(const ToolShape& shape, const TissueView& view, Hold point) noexcept {
  const Vec3d local = to_jaw(shape, held_point(view, point));
  for (int k = 0; k < 3; ++k) point.local[k] = float(local[k]), point.force[k] = 0;
  return point;
}

double stuck_pull(const ToolShape& shape, const TissueView& view, const Hold& stuck) noexcept {
  return kStiffness * length(target_of(shape, stuck) - held_point(view, stuck));
}

void stuck_load(const ToolShape& shape, int tool_index, const TissueView& view, const Hold& stuck,
                std::span<StrandLoads> strand_loads, std::span<NetworkLoads> organ_loads,
                std::span<NetworkLoads> membrane_loads) noexcept {
  const Vec3d target = target_of(shape, stuck);
  const Tag tag{Owner::tool_contact, tool_index, 0};
  if (stuck.body >= kMembraneBase) {
    tissue::NodeLoad load;
    load.node = stuck.element;
    load.k = float(kStiffness);
    load.d = float(kDamping);
    load.x0 = vec_cast<float>(target);
    membrane_loads[std::size_t(stuck.body - kMembraneBase)].add(load, tag);
  } else if (stuck.body >= kSolidBase) {
    const std::size_t organ = std::size_t(stuck.body - kSolidBase);
    const Surface& surface = view.solids[organ];
    SkinLoad load;
    load.k = kStiffness;
    load.d = kDamping;
    load.shift = target - surface.position(stuck.element);
    add_skin_load(surface.nodes, *surface.skin, stuck.element, load, tag, organ_loads[organ]);
  } else {
    tissue::StrandLoad load;
    load.element = stuck.element;
    load.w = double(stuck.weight);
    load.k = kStiffness;
    load.d = kDamping;
    load.x0 = target;
    strand_loads[std::size_t(stuck.body)].add(load, tag);
  }
}

}  // namespace trocar::interactions
