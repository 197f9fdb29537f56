#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

tissue::NodeView nodes_of(const Model& model, const State& s, int organ) noexcept {
  const size_t i = size_t(organ), n = model.solids.size();
  return i < n ? view_of(model.solids[i].network, s.solids[i])
               : view_of(model.cuttables[i - n].body, s.cuttables[i - n]);
}

}  // namespace trocar::sim
