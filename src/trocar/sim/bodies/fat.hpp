// Fat in a step: what it holds on, what parts it, and current that goes into it (interactions/objects/fat.hpp).
#pragma once

#include <trocar/geometry/tets/blade.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Before the loads of bonds: what holds coagulated lobules gives way sooner.
void weaken_coagulated(StepContext& context) noexcept;

/// Septa that the blade passes hold no more. @return how many
int sever_septa(StepContext& context, const geometry::Blade& blade) noexcept;

/// A lobule that a bare wire touches.
struct FatTouch {
  interactions::MaterialPoint at;  ///< its middle
  Vec3d place;                     ///< that [m]
  double apart = 0;                ///< of its surface from the metal's; below 0: that is in it [m]
  bool there() const noexcept { return at.body.exists(); }
};
FatTouch fat_at(const StepContext& context, std::size_t hand) noexcept;

/// What an electrode meets there.
tissue::HeatContact fat_contact(const StepContext& context, const FatTouch& touch) noexcept;
/// Gives it what current brings. @return water that has boiled off [kg]
double warm_fat(StepContext& context, const FatTouch& touch, double joules) noexcept;

/// Does a lobule lie between the two points?
bool behind_fat(const Model& model, const State& state, Vec3d from, Vec3d to) noexcept;

}  // namespace trocar::sim
