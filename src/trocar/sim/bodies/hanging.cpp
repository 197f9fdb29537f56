#include <trocar/sim/bodies/hanging.hpp>

namespace trocar::sim {
namespace {

using interactions::Owner;

constexpr double kHangingDamping = 0.02;  // [s] times stiffness: fat and folds that carry an organ yield slowly

void hang(std::span<const tissue::Anchor> anchors, size_t organ, interactions::NetworkLoads& loads) noexcept {
  for (const tissue::Anchor& a : anchors) {
    tissue::NodeLoad load;
    load.node = a.node;
    load.k = float(a.k);
    load.d = float(a.k * kHangingDamping);
    load.x0 = vec_cast<float>(a.x0);
    load.f0 = vec_cast<float>(a.k * (a.x0 - vec_cast<double>(load.x0)));
    loads.add(load, {Owner::anchor, std::int32_t(organ), 0});
  }
}

}  // namespace

void hang(std::span<const tissue::Anchor> anchors, size_t organ, const Carried& by_breath,
          interactions::NetworkLoads& loads) noexcept {
  if (!by_breath.moves) return hang(anchors, organ, loads);
  for (const tissue::Anchor& a : anchors) {
    tissue::NodeLoad load;
    load.node = a.node;
    load.k = float(a.k);
    load.d = float(a.k * kHangingDamping);
    const Vec3d held_at = a.x0 + by_breath.x;
    load.x0 = vec_cast<float>(held_at);
    load.f0 = vec_cast<float>(a.k * (held_at - vec_cast<double>(load.x0)) + (a.k * kHangingDamping) * by_breath.v);
    loads.add(load, {Owner::anchor, std::int32_t(organ), 0});
  }
}

}  // namespace trocar::sim
