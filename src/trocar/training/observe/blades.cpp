#include <trocar/interactions/verbs/between_blades.hpp>
#include <trocar/training/observe/blades.hpp>

namespace trocar::training {

bool organ_between_blades(const sim::Model& model, const sim::State& state, const interactions::ToolModel& tool,
                          const interactions::ToolShape& shape, double beyond) {
  const geometry::Blade blade = interactions::closed_blades(tool, shape, beyond);
  const geometry::BladePlane plane(blade);
  bool any = false;
  for (size_t i = 0; i < model.solids.size() && !any; ++i)
    any = interactions::crosses(plane, model.solids[i].network, state.solids[i]);
  return any;
}

double strand_between_blades(const sim::Model& model, const sim::State& state, const interactions::ToolModel& tool,
                             const interactions::ToolShape& shape, int strand) {
  return interactions::between_blades(tool, shape, model.strand_bodies[size_t(strand)], state.strands[size_t(strand)])
      .fraction;
}

}  // namespace trocar::training
